#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/motion.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/core/random.hpp"

namespace waymark::app {

/// FastSLAM 1.0 as one writes it: particles that each own their map, range and bearing, identities known and
/// numbered from 0, low variance resampling by copying. What our own steps are compared with.
class PlainFastSlam {
 public:
  PlainFastSlam(int particles, std::span<const Observation> all_landmarks);

  void step(const Motion& motion, std::span<const Observation> observations);
  [[nodiscard]] Pose2 pose() const { return particles_.front().T_world_robot; }

 private:
  struct Landmark {
    Eigen::Vector2d mean;
    Eigen::Matrix2d covariance;
  };
  struct Particle {
    Pose2 T_world_robot;
    double log_weight = 0.0;
    std::vector<Landmark> landmarks;
  };

  static void update(Particle& particle, const Observation& observation);
  void resample();

  std::vector<Particle> particles_;
  std::vector<Particle> chosen_;
  RandomStream random_{1, StreamPurpose::kMotion};
};

}  // namespace waymark::app
