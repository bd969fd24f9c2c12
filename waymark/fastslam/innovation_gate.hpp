#pragma once

#include <cstddef>

#include "waymark/association/gate.hpp"
#include "waymark/fastslam/belief.hpp"
#include "waymark/fastslam/scan.hpp"
#include "waymark/fastslam/sensor_model.hpp"

namespace waymark::fastslam {

/// Whether an observation is what the set as a whole expects: the NIS by mean and covariance of the
/// innovation over all particles, their spread included. A gate on each particle would let those starve that
/// the odometry happened to lead astray.
class InnovationGate {
 public:
  InnovationGate(const GateOptions& options, const SensorModel& model) : gate_(options), model_(model) {}

  /// Compares one with the landmark that was found for it, and says what becomes of it: the moments and the
  /// innovation of the scan. Needs Belief::load_sample(), gathers the landmark.
  void judge(std::size_t index, Scan& scan, Belief& belief) const;

  /// The innovation of an observation against a gathered landmark. Needs Belief::load_sample().
  [[nodiscard]] InnovationMoments compare(const Observation& observation, int landmark,
                                          Belief& belief) const {
    return belief.compare(model_.landmark_observation(observation, landmark, belief));
  }

  /// Chi-square quantile of the NIS for 1 or 2 degrees of freedom.
  [[nodiscard]] double threshold(int dof) const { return gate_.threshold(dof); }

 private:
  Gate gate_;
  SensorModel model_;
};

}  // namespace waymark::fastslam
