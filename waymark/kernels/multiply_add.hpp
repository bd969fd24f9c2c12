#pragma once

#include <cstddef>

namespace waymark::kernels {

/// `rounds` rounds of independent multiply-adds on vectors of double, all in registers: what a processor can
/// do at most.
struct MultiplyAdds {
  double flop = 0.0;  ///< two per lane and multiply-add
  double sum = 0.0;   ///< of all lanes, so that the work is not optimised away
};
[[nodiscard]] MultiplyAdds multiply_add(std::size_t rounds);

}  // namespace waymark::kernels
