#pragma once

#include <vector>

#include <Eigen/Core>

#include "waymark/core/observation.hpp"

namespace waymark {

/// The reflectors in a scan of a laser that also measures how bright its echoes are: one for each run of
/// bright beams, the bearing in its middle and the range at its median. Beam k of n points to
/// (k / (n - 1) - 1/2) pi from ahead. `intensities` is 0 where the echo was plain. Runs end at gaps of more
/// than two beams; ranges below 0.5 m and from 75 m up are none. O(n log n).
[[nodiscard]] std::vector<RangeBearing> find_reflectors(const Eigen::VectorXd& ranges_m,
                                                        const Eigen::VectorXd& intensities);

}  // namespace waymark
