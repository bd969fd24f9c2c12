#pragma once

namespace waymark::ekf {

/// How far away something may be that was seen once.
struct DepthPrior {
  enum class Spacing { kInverseDepth, kDepth };

  int particles = 100;
  double nearest_m = 0.5;
  double farthest_m = 15.0;
  Spacing spacing = Spacing::kInverseDepth;
};

}  // namespace waymark::ekf
