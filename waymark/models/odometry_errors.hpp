#pragma once

#include <Eigen/Core>

#include "waymark/core/pose2.hpp"

namespace waymark {

/// What is always wrong with an odometry, in this order: speed scale and turn scale, of which true is 1 + c
/// times measured, and a turning rate that is missing, rad/s while the robot moves. Of two wheels the scales
/// tell the mean radius and the track, track = measured (1 + speed scale) / (1 + turn scale), and the rate
/// takes what the radii differ by.
using OdometryErrors = Eigen::Vector3d;

/// An increment as it truly was if these are the errors, and its Jacobian d(x, y, theta)/d(errors).
struct CorrectedIncrement {
  Pose2 increment;
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
};

/// One step that took so long: the same arc, longer and turning more. One that stands stays.
[[nodiscard]] CorrectedIncrement corrected(const Pose2& increment, double dt_s, const OdometryErrors& errors);

}  // namespace waymark
