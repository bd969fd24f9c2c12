#pragma once

#include <cstddef>

namespace waymark::kernels {

/// W <- L^-1 W in place, for the lower triangular L: D x D row-major with stride ldl, and W: D x n stored as
/// in layout.hpp. Entries of L above its diagonal are not read. n D^2 flop.
void triangular_solve(const double* L, std::size_t ldl, std::size_t D, double* W, std::size_t ldw,
                      std::size_t n);

namespace reference {
void triangular_solve(const double* L, std::size_t ldl, std::size_t D, double* W, std::size_t ldw,
                      std::size_t n);
}  // namespace reference

}  // namespace waymark::kernels
