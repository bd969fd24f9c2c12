#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "waymark/core/pose2.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark::fastslam {

/// From where the sensor looked at the last scans, by odometry alone. A landmark that it sees now and did not
/// see then was out of its view: this tells where on its ray or ring it can be.
class ViewHistory {
 public:
  explicit ViewHistory(const LandmarkSensor& sensor);

  /// The robot moves by this increment.
  void move(const Pose2& increment);
  /// The sensor looks.
  void scan();

  /// How many scans before the last one are remembered.
  [[nodiscard]] std::size_t earlier() const;
  /// The robot at the scan `age` scans before the last one, age <= earlier(), seen from where it is now.
  [[nodiscard]] Pose2 T_now_at(std::size_t age) const;

  /// Probability that a landmark at `p_sensor` (m, sensor frame, now) was in none of the earlier scans: the
  /// product over them of 1 - detection_probability where it was in view by a margin. O(kScans).
  [[nodiscard]] double likelihood_unseen(const Eigen::Vector2d& p_sensor, const ViewMargin& margin) const;

 private:
  static constexpr std::size_t kScans = 8;

  LandmarkSensor sensor_;
  Pose2 T_odom_robot_;
  std::array<Pose2, kScans> scans_;
  std::size_t count_ = 0;
};

}  // namespace waymark::fastslam
