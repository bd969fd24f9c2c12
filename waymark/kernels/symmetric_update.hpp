#pragma once

#include <cstddef>

namespace waymark::kernels {

/// The rows [begin, end) of a matrix.
struct RowBand {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Band `index` of `count` bands of about equal area of the upper triangle of an n x n matrix. Bands of one
/// matrix may be updated at the same time; the result has the same bits however many there are.
RowBand triangle_band(std::size_t n, std::size_t index, std::size_t count);

/// P -= W^T W on the rows of `band` of the upper triangle. P: n x n, W: D x n, stored as in layout.hpp. This
/// is the O(n^2) part of an EKF correction: n^2 D flop for the whole of P, which is read and written once.
void symmetric_downdate(double* P, std::size_t ld, std::size_t n, const double* W, std::size_t ldw,
                        std::size_t D, RowBand band);

/// P += -W^T W + d e^T + e d^T in the same single pass. d, e: n values, aligned and padded like a row of W.
///
/// The covariance shear of the invariant EKF (Barrau and Bonnabel 2015), P + d c^T + c d^T + c_th d d^T with
/// c the heading column of P - W^T W, has this form with e = c + c_th/2 d.
void symmetric_update(double* P, std::size_t ld, std::size_t n, const double* W, std::size_t ldw,
                      std::size_t D, const double* d, const double* e, RowBand band);

/// P += -A^T B + d e^T + e d^T on the rows of `band` of the upper triangle, for A and B: D x n whose product
/// is symmetric. d and e may be null. What a submap of the compressed EKF (Guivant and Nebot 2001) did to the
/// covariance of the landmarks outside of it has this form, with B = psi A.
void symmetric_product_update(double* P, std::size_t ld, std::size_t n, const double* A, const double* B,
                              std::size_t ldw, std::size_t D, const double* d, const double* e, RowBand band);

/// P -= A^T B on the whole rows of `band`, for P with n columns, A with D rows of at least band.end columns
/// and B: D x n. 2 n D flop per row.
void subtract_product(double* P, std::size_t ld, std::size_t n, const double* A, std::size_t lda,
                      const double* B, std::size_t ldb, std::size_t D, RowBand band);

namespace reference {

/// The plain formula on the whole upper triangle; d and e may be null.
void symmetric_update(double* P, std::size_t ld, std::size_t n, const double* W, std::size_t ldw,
                      std::size_t D, const double* d, const double* e);

}  // namespace reference
}  // namespace waymark::kernels
