#pragma once

#include "waymark/kernels/instructions.hpp"

namespace waymark::vision {

struct CornerOptions {
  int threshold = 20;  ///< grey levels, 1 to 254
  int arc = 12;        ///< pixels of the circle of 16, 9 to 12
  kernels::Instructions instructions = kernels::Instructions::kSimd;
};

}  // namespace waymark::vision
