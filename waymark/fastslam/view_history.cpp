#include "waymark/fastslam/view_history.hpp"

#include <algorithm>

namespace waymark::fastslam {

ViewHistory::ViewHistory(const LandmarkSensor& sensor) : sensor_(sensor) {}

void ViewHistory::move(const Pose2& increment) { T_odom_robot_ = T_odom_robot_ * increment; }

void ViewHistory::scan() { scans_[count_++ % kScans] = T_odom_robot_; }

std::size_t ViewHistory::earlier() const {
  return std::min(count_, kScans) - std::min<std::size_t>(count_, 1);
}

Pose2 ViewHistory::T_now_at(std::size_t age) const {
  return T_odom_robot_.inverse() * scans_[(count_ - 1 - age) % kScans];
}

double ViewHistory::likelihood_unseen(const Eigen::Vector2d& p_sensor, const ViewMargin& margin) const {
  const Pose2 T_robot_sensor = sensor_.T_robot_sensor();
  const Eigen::Vector2d p_robot = T_robot_sensor * p_sensor;
  double likelihood = 1.0;
  for (std::size_t age = 1; age <= earlier(); ++age) {
    const Pose2 T_now_sensor = T_now_at(age) * T_robot_sensor;
    if (is_in_view(sensor_, T_now_sensor.inverse() * p_robot, margin))
      likelihood *= 1.0 - sensor_.detection_probability;
  }
  return likelihood;
}

}  // namespace waymark::fastslam
