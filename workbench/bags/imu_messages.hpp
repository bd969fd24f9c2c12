#pragma once

#include <Eigen/Core>

#include "workbench/bags/topic_reader.hpp"

namespace waymark::bag {

inline constexpr std::string_view kImu = "sensor_msgs/Imu";

/// How likely the topic is the gyro of the robot, the best first; below 0: it is none. Gyros of cameras stand
/// behind others, accelerometers alone behind all.
[[nodiscard]] int imu_rank(const Topic& topic);

/// The axis of the IMU that is the vertical by the acceleration of a message, upwards: that along which it
/// measures gravity, else z.
[[nodiscard]] Eigen::Vector3d vertical_by_gravity(const Topic& topic, std::string_view bytes);

/// The angular velocity about the robot's vertical, a unit vector in the IMU's axes, becomes YawRate. A
/// message whose covariance says that it has no angular velocity can not be used.
[[nodiscard]] Result<TopicReader> imu_reader(const Topic& topic, const Eigen::Vector3d& vertical);

}  // namespace waymark::bag
