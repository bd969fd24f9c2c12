#include "waymark/smooth/factors.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include "waymark/models/observation_models.hpp"

namespace waymark::smooth {
namespace {

Pose2 moved_mount(const Pose2& T_robot_sensor, const Calibration& c) {
  return {T_robot_sensor.x_m + c[kMountX], T_robot_sensor.y_m + c[kMountY], T_robot_sensor.theta_rad};
}

/// Predicted range and bearing of a calibrated sensor, less what was measured of them.
struct Predicted {
  Eigen::Vector2d residual;
  Linearization<2> model;
  Eigen::Matrix<double, 2, kCalibrationSize> J_calibration;
};

Predicted predict(const Eigen::Vector2d& measured, const Pose2& T_world_robot, const Pose2& T_robot_sensor,
                  const Eigen::Vector2d& p_world, const Calibration& c) {
  Predicted predicted;
  predicted.model = RangeBearingModel::linearize(T_world_robot, moved_mount(T_robot_sensor, c), p_world);
  const double distance_m = predicted.model.predicted[0];
  const double scale = 1.0 + c[kRangeScale];
  predicted.residual = {scale * distance_m + c[kRangeOffset] - measured[0],
                        wrap_angle(predicted.model.predicted[1] + c[kBearingOffset] - measured[1])};
  predicted.model.H_pose.row(0) *= scale;
  predicted.model.H_landmark.row(0) *= scale;
  predicted.J_calibration.setZero();
  predicted.J_calibration(0, kRangeScale) = distance_m;
  predicted.J_calibration(0, kRangeOffset) = 1.0;
  predicted.J_calibration(1, kBearingOffset) = 1.0;
  // A sensor that moves ahead sees what a landmark that comes nearer shows.
  static_assert(kMountY == kMountX + 1);
  predicted.J_calibration.middleCols<2>(kMountX) = -predicted.model.H_landmark * T_world_robot.rotation();
  return predicted;
}

/// Where the robot was when a late observation was made, in its frame at the stamp of that.
Pose2 delayed_pose(const ObservationEdge& observation, const Calibration& c) {
  const Eigen::Vector3d back = -c[kDelay] * observation.velocity;
  return {back.x(), back.y(), back.z()};
}

/// From Jacobians to the pose when it was seen to those to the pose at its stamp, and to the delay.
void account_for_delay(Predicted& predicted, const Eigen::Vector3d& velocity, const Pose2& T_world_robot,
                       const Pose2& T_world_seen) {
  auto& H = predicted.model.H_pose;
  const Eigen::Vector2d v_world = T_world_robot.rotation() * velocity.head<2>();
  predicted.J_calibration.col(kDelay) = -H.leftCols<2>() * v_world - H.col(2) * velocity.z();
  H.col(2) += H.leftCols<2>() * perpendicular(T_world_seen.position() - T_world_robot.position());
}

/// Rows of a prediction, divided by the square root of their covariance.
template <int Dim>
ObservationFactor whiten(const Predicted& predicted, Eigen::Index first_row,
                         const Eigen::Matrix<double, Dim, Dim>& covariance) {
  const Eigen::LLT<Eigen::Matrix<double, Dim, Dim>> root(covariance);
  const auto divide = [&](const auto& rows) {
    return root.matrixL().solve(rows.template middleRows<Dim>(first_row)).eval();
  };
  ObservationFactor factor;
  factor.dof = Dim;
  factor.residual.template head<Dim>() = divide(predicted.residual);
  factor.J_pose.template topRows<Dim>() = divide(predicted.model.H_pose);
  factor.J_landmark.template topRows<Dim>() = divide(predicted.model.H_landmark);
  factor.J_calibration.template topRows<Dim>() = divide(predicted.J_calibration);
  return factor;
}

using Scalar = Eigen::Matrix<double, 1, 1>;

}  // namespace

OdometryFactor linearize_odometry(const Pose2& T_world_before, const Pose2& T_world_after,
                                  const CalibratedMotion& measured) {
  const Pose2 between = T_world_before.inverse() * T_world_after;
  const Eigen::Matrix2d Rt = T_world_before.rotation().transpose();
  OdometryFactor factor;
  factor.residual = difference(between, measured.increment);
  factor.J_after.setIdentity();
  factor.J_after.topLeftCorner<2, 2>() = Rt;
  factor.J_before = -factor.J_after;
  factor.J_before.topRightCorner<2, 1>() = -perpendicular(between.position());
  factor.J_calibration = -measured.J;
  return factor;
}

OdometryFactor whiten_by_error_source(OdometryFactor factor, const Eigen::Vector3d& measured_part,
                                      const Calibration& calibration) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    const CalibrationIndex which = i == 2 ? kTurnScale : kSpeedScale;
    const double scale = 1.0 + calibration[which];
    const double variance = 1.0 + measured_part[i] * (scale * scale - 1.0);
    const double unit = 1.0 / std::sqrt(variance);
    factor.residual[i] *= unit;
    factor.J_before.row(i) *= unit;
    factor.J_after.row(i) *= unit;
    factor.J_calibration.row(i) *= unit;
    factor.J_calibration(i, which) -= measured_part[i] * scale / variance * factor.residual[i];
  }
  return factor;
}

ObservationFactor linearize_observation(const ObservationEdge& observation, const Pose2& T_world_robot,
                                        const Pose2& T_robot_sensor, const Eigen::Vector2d& p_world,
                                        const Calibration& calibration) {
  const Pose2 T_world_seen = T_world_robot * delayed_pose(observation, calibration);
  const Pose2 T_world_sensor = T_world_seen * moved_mount(T_robot_sensor, calibration);
  if ((p_world - T_world_sensor.position()).norm() < kMinDistance_m) return {};
  const auto predicted = [&](double range_m, double bearing_rad) {
    Predicted seen = predict({range_m, bearing_rad}, T_world_seen, T_robot_sensor, p_world, calibration);
    account_for_delay(seen, observation.velocity, T_world_robot, T_world_seen);
    return seen;
  };
  const Eigen::Matrix2d& R = observation.covariance;
  if (const auto* z = std::get_if<RangeBearing>(&observation.value))
    return whiten<2>(predicted(z->range_m, z->bearing_rad), 0, R);
  if (const auto* z = std::get_if<Range>(&observation.value))
    return whiten<1>(predicted(z->range_m, 0.0), 0, Scalar(R(0, 0)));
  if (const auto* z = std::get_if<Bearing>(&observation.value))
    return whiten<1>(predicted(0.0, z->bearing_rad), 1, Scalar(R(0, 0)));
  return {};
}

}  // namespace waymark::smooth
