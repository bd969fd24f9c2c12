#pragma once

#include <Eigen/Core>

#include "waymark/core/pose2.hpp"

namespace waymark {

/// Motion of the robot over one step, from any kind of odometry: the increment in the frame before the
/// step, and its covariance.
struct Motion {
  Pose2 increment;  ///< T_before_after
  Eigen::Matrix3d covariance =
      Eigen::Matrix3d::Zero();  ///< of (x, y, theta) of the increment, robot frame before
  double duration_s = 0.0;      ///< that it took, where that is known
};

/// The robot stood still: no noise enters, no particle is moved.
[[nodiscard]] inline bool is_still(const Motion& motion) {
  return motion.increment == Pose2{} && motion.covariance.isZero(0.0);
}

/// Neither its increment nor its covariance holds a NaN or an infinity.
[[nodiscard]] bool is_finite(const Motion& motion);

/// How far a motion takes the robot's view along, m: its length, and its turn as 0.3 m per radian. A turn on
/// the spot shows a landmark from no new place, but at a new bearing.
[[nodiscard]] double travelled_m(const Motion& motion);

/// Two motions in a row as one: T_0_2 = T_0_1 * T_1_2, covariance to first order.
[[nodiscard]] Motion compose(const Motion& first, const Motion& second);

/// A pose with its covariance in (x, y, theta), world frame.
struct PoseEstimate {
  Pose2 T_world_robot;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// The pose after a motion, covariance to first order: F P F^T + G Q G^T.
[[nodiscard]] PoseEstimate propagate(const PoseEstimate& before, const Motion& motion);

}  // namespace waymark
