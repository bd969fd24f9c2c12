#pragma once

#include "waymark/core/config.hpp"
#include "waymark/kernels/instructions.hpp"

namespace waymark::vision {

struct CornerOptions {
  int threshold = 20;  ///< grey levels, 1 to 254
  int arc = 12;        ///< pixels of the circle of 16, 9 to 12
  kernels::Instructions instructions = kernels::Instructions::kSimd;
};

void describe(Schema& schema, CornerOptions& options);

}  // namespace waymark::vision
