#pragma once

#include <Eigen/Core>

#include "waymark/smooth/graph.hpp"

namespace waymark::smooth {

/// What two poses say about a motion between them, in the frame of the first: residual = estimated - measured
/// in (x, y, theta), and its Jacobians.
struct OdometryFactor {
  Eigen::Vector3d residual;
  Eigen::Matrix3d J_before, J_after;
  Eigen::Matrix<double, 3, kCalibrationSize> J_calibration;
};

[[nodiscard]] OdometryFactor linearize_odometry(const Pose2& T_world_before, const Pose2& T_world_after,
                                                const CalibratedMotion& measured);

/// The same in units of its standard deviations as they are by a calibration over what they are without one.
/// Errors of the measurement grow with the scales, and a robot that strays does not: were that forgotten,
/// scales would be found too small in the first case and too large in the second (Deming 1943).
[[nodiscard]] OdometryFactor whiten_by_error_source(OdometryFactor factor,
                                                    const Eigen::Vector3d& measured_part,
                                                    const Calibration& calibration);

/// Residual = predicted - measured of an observation and its Jacobians, in units of its standard deviations.
/// Of observations with one number the second row is zero.
struct ObservationFactor {
  int dof = 0;
  Eigen::Vector2d residual = Eigen::Vector2d::Zero();
  Eigen::Matrix<double, 2, 3> J_pose = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix2d J_landmark = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 2, kCalibrationSize> J_calibration =
      Eigen::Matrix<double, 2, kCalibrationSize>::Zero();
};

/// Nothing (0 degrees of freedom) where the landmark lies in the sensor.
[[nodiscard]] ObservationFactor linearize_observation(const ObservationEdge& observation,
                                                      const Pose2& T_world_robot, const Pose2& T_robot_sensor,
                                                      const Eigen::Vector2d& p_world,
                                                      const Calibration& calibration);

}  // namespace waymark::smooth
