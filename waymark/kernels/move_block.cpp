#include "waymark/kernels/move_block.hpp"

#include <algorithm>

namespace waymark::kernels {

void move_block(double* P, std::size_t ld, std::size_t n, std::size_t from, std::size_t to,
                std::size_t size) {
  for (std::size_t j = 0; j < to; ++j) std::copy_n(P + j * ld + from, size, P + j * ld + to);
  for (std::size_t a = 0; a < size; ++a)
    std::copy_n(P + (from + a) * ld + from + a, size - a, P + (to + a) * ld + to + a);
  // Between the two places the moved part turns from columns into rows.
  for (std::size_t j = to + size; j < from; ++j)
    for (std::size_t a = 0; a < size; ++a) P[(to + a) * ld + j] = P[j * ld + from + a];
  for (std::size_t a = 0; a < size; ++a)
    std::copy_n(P + (from + a) * ld + from + size, n - from - size, P + (to + a) * ld + from + size);
}

}  // namespace waymark::kernels
