#pragma once

#include <cstddef>

namespace waymark::kernels {

/// x += W^T y for W: D x n stored as in layout.hpp and y of D values. x: n values, aligned and padded like a
/// row of W. The state increment of an EKF correction with y = L^-1 nu; a column of W^T W with y = W(:, i). 2
/// n D flop.
void add_scaled_rows(double* x, const double* W, std::size_t ldw, std::size_t D, const double* y,
                     std::size_t n);

namespace reference {
void add_scaled_rows(double* x, const double* W, std::size_t ldw, std::size_t D, const double* y,
                     std::size_t n);
}  // namespace reference

}  // namespace waymark::kernels
