#pragma once

#include <string>

#include "workbench/bags/topic_reader.hpp"

namespace waymark::bag {

/// The joints whose positions are the angles of the wheels; empty: those with "left" or "right" and "wheel"
/// in their names.
struct WheelJoints {
  std::string left;
  std::string right;
};

/// How much the type says about the motion, the best first: 0 for nav_msgs/Odometry, then JointState,
/// TwistStamped, Twist and PoseStamped; below 0 for a type that is no odometry.
[[nodiscard]] int odometry_rank(std::string_view type);

/// Odometry and PoseStamped become OdometryPose, JointState WheelAngles, and both twists Velocity.
[[nodiscard]] Result<TopicReader> odometry_reader(const Topic& topic, const WheelJoints& joints);

/// nav_msgs/Odometry and PoseStamped as ground truth.
[[nodiscard]] Result<TopicReader> truth_reader(const Topic& topic);

}  // namespace waymark::bag
