#pragma once

#include <vector>

#include "waymark/core/motion.hpp"
#include "waymark/core/observation.hpp"

namespace waymark::app {

/// Per step of what is compared with other programs.
inline constexpr int kObservations = 10;

/// A robot on a circle in a field of landmarks, one per 16 m^2, in the middle of the square that they fill.
struct SyntheticRun {
  struct Step {
    Motion motion;              ///< 0.3 m ahead, with noise
    Observations observations;  ///< of the nearest landmarks: 0.05 m, 0.5 deg
  };
  Motion start;  ///< no movement, a little uncertainty: every entry of the covariance gets populated
  Observations first_look;  ///< all landmarks, so that every step runs at the full state size
  std::vector<Step> steps;
};

/// `observations_per_step` of the nearest landmarks; the same arguments give the same run.
[[nodiscard]] SyntheticRun make_synthetic_run(int landmarks, int observations_per_step, int steps);

}  // namespace waymark::app
