#pragma once

#include <cstddef>

namespace waymark::kernels {

/// Rows and columns from .. from + size - 1 of the symmetric P take the place of those at `to`, whose values
/// are lost: with the last landmark onto another one, what is left after removing that one. Needs to + size
/// <= from and from + size <= n. O(size n).
void move_block(double* P, std::size_t ld, std::size_t n, std::size_t from, std::size_t to, std::size_t size);

}  // namespace waymark::kernels
