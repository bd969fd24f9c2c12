#pragma once

#include "waymark/kernels/instructions.hpp"
#include "waymark/vision/corner_options.hpp"
#include "waymark/vision/finder_options.hpp"
#include "waymark/vision/frame_budget.hpp"
#include "waymark/vision/new_corner_options.hpp"

namespace waymark::vision {

struct TrackerOptions {
  int max_observed = 30;  ///< landmarks searched for in one image
  FinderOptions finder;
  CornerOptions corners;
  NewCornerOptions new_corners;
  FrameBudgetOptions budget;
  kernels::Instructions instructions = kernels::Instructions::kSimd;
};

}  // namespace waymark::vision
