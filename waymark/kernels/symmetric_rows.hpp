#pragma once

#include <cstddef>

namespace waymark::kernels {

/// The most rows that project_rows() and transform_leading_rows() combine: as many as the largest observation
/// of an EKF depends on, with three of the robot, three points of three coordinates and three pairs of
/// biases.
inline constexpr std::size_t kMaxRows = 18;

/// The whole rows first .. first + count - 1 of the symmetric P, from its upper triangle, into a count x n
/// panel with stride ldo. Left of the diagonal a row is a column in memory, one cache line per element.
void gather_rows(const double* P, std::size_t ld, std::size_t n, std::size_t first, std::size_t count,
                 double* out, std::size_t ldo);

/// C = H P(rows, :), a D x n panel, for the R <= kMaxRows rows of P at `rows` and H: D x R row-major. With
/// the robot's and one landmark's rows this is that landmark's part of H P. C must not overlap P. O((R + D R)
/// n).
void project_rows(const double* P, std::size_t ld, std::size_t n, const std::size_t* rows, std::size_t R,
                  const double* H, std::size_t D, double* C, std::size_t ldc);

/// P(0:q, q:n) <- Phi P(0:q, q:n), for Phi: q x q row-major, q <= kMaxRows: how a motion of the robot carries
/// its correlations with the map along. The leading q x q block is left to the caller. O(q^2 n).
void transform_leading_rows(double* P, std::size_t ld, std::size_t n, const double* Phi, std::size_t q);

namespace reference {

void project_rows(const double* P, std::size_t ld, std::size_t n, const std::size_t* rows, std::size_t R,
                  const double* H, std::size_t D, double* C, std::size_t ldc);
void transform_leading_rows(double* P, std::size_t ld, std::size_t n, const double* Phi, std::size_t q);

}  // namespace reference
}  // namespace waymark::kernels
