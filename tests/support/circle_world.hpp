#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/filter.hpp"
#include "waymark/core/gaussian.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/core/random.hpp"
#include "waymark/models/landmark_sensor.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark::test {

/// A robot on a circle among eight landmarks that it sees one and all, with noise as its sensors claim it.
class CircleWorld {
 public:
  explicit CircleWorld(std::uint64_t seed) : random_(seed, StreamPurpose::kSimulation) {
    for (int i = 0; i < 8; ++i)
      landmarks_.emplace_back(6.0 * std::cos(i * kPi / 4.0) + 1.0, 6.0 * std::sin(i * kPi / 4.0) + 3.0);
  }

  /// Drives one step and returns what the odometry says of it.
  Motion move() {
    const Eigen::Vector3d sigma(0.01, 0.005, 0.01);
    const Pose2 step{0.1, 0.0, 0.03};
    const double x_m = step.x_m + sigma[0] * random_.normal();
    const double y_m = sigma[1] * random_.normal();
    const double theta_rad = step.theta_rad + sigma[2] * random_.normal();
    truth_ = truth_ * Pose2{x_m, y_m, theta_rad};
    return {step, sigma.cwiseAbs2().asDiagonal()};
  }

  std::vector<Observation> look() {
    std::vector<Observation> scan;
    for (int i = 0; i < 8; ++i) scan.push_back(sight(i));
    return scan;
  }

  Observation sight(int landmark) {
    const Eigen::Vector2d sigma(0.05, 0.02);
    const Eigen::Vector2d& p_world = landmarks_[static_cast<std::size_t>(landmark)];
    const auto z = RangeBearingModel::linearize(truth_, mount_, p_world).predicted;
    const double range_m = z[0] + sigma[0] * random_.normal();
    const double bearing_rad = wrap_angle(z[1] + sigma[1] * random_.normal());
    return {LandmarkId{LandmarkId::Family::kMarker, landmark}, RangeBearing{range_m, bearing_rad},
            Eigen::Matrix2d(sigma.cwiseAbs2().asDiagonal())};
  }

  [[nodiscard]] const Pose2& truth() const { return truth_; }
  [[nodiscard]] const Pose2& mount() const { return mount_; }
  [[nodiscard]] LandmarkSensor sensor() const {
    return {
        .x_m = mount_.x_m, .y_m = mount_.y_m, .yaw_deg = to_degrees(mount_.theta_rad), .max_range_m = 20.0};
  }
  [[nodiscard]] const std::vector<Eigen::Vector2d>& landmarks() const { return landmarks_; }

 private:
  RandomStream random_;
  std::vector<Eigen::Vector2d> landmarks_;
  Pose2 truth_;
  Pose2 mount_{0.2, -0.1, 0.3};
};

/// Mean pose NEES over 60 worlds; `drive` drives through one and returns what a filter thinks of its pose.
template <class Drive>
double mean_pose_nees(const Drive& drive) {
  constexpr int kRuns = 60;
  double nees = 0.0;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    CircleWorld world(seed);
    const PoseEstimate pose = drive(world);
    nees += *mahalanobis_squared<3>(difference(world.truth(), pose.T_world_robot), pose.covariance);
  }
  return nees / kRuns;
}

/// 99.9 % band of a mean of 60 chi-square variables with three degrees of freedom.
inline constexpr double kMinMeanNees = 2.05;
inline constexpr double kMaxMeanNees = 4.12;

}  // namespace waymark::test
