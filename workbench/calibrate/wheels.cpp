#include "workbench/calibrate/wheels.hpp"

namespace waymark::calibrate {
namespace {

/// By how much the right radius is larger than the left one, as a part of their mean, beyond what the config
/// says: the robot turns by this over the track per metre.
double radius_difference(const WheelGeometry& wheels, const Calibration& c) {
  return c[kTurnPerMetre] * wheels.track_m / (1.0 + c[kTurnScale]);
}

}  // namespace

WheelGeometry with_scales(const OdometryOptions& odometry) {
  const WheelGeometry& wheels = odometry.wheels;
  return {odometry.speed_scale * wheels.left_radius_m, odometry.speed_scale * wheels.right_radius_m,
          wheels.track_m * odometry.speed_scale / odometry.turn_scale};
}

WheelGeometry corrected(const WheelGeometry& wheels, const Calibration& c) {
  const double larger = 1.0 + c[kSpeedScale];
  const double half = 0.5 * radius_difference(wheels, c);
  return {larger * (1.0 - half) * wheels.left_radius_m, larger * (1.0 + half) * wheels.right_radius_m,
          larger / (1.0 + c[kTurnScale]) * wheels.track_m};
}

Calibration deviation(const WheelGeometry& from, const WheelGeometry& to) {
  const double left = to.left_radius_m / from.left_radius_m;
  const double right = to.right_radius_m / from.right_radius_m;
  const double larger = 0.5 * (left + right);
  const double turning_more = larger * from.track_m / to.track_m;
  Calibration c = Calibration::Zero();
  c[kSpeedScale] = larger - 1.0;
  c[kTurnScale] = turning_more - 1.0;
  c[kTurnPerMetre] = (right - left) / larger * turning_more / from.track_m;
  return c;
}

Eigen::Matrix<double, 3, kCalibrationSize> log_jacobian(const WheelGeometry& wheels, const Calibration& c) {
  const double half = 0.5 * radius_difference(wheels, c);
  const double turning_more = 1.0 + c[kTurnScale];
  const Eigen::Vector3d to_half(-1.0 / (1.0 - half), 1.0 / (1.0 + half), 0.0);
  Eigen::Matrix<double, 3, kCalibrationSize> J = Eigen::Matrix<double, 3, kCalibrationSize>::Zero();
  J.col(kSpeedScale).setConstant(1.0 / (1.0 + c[kSpeedScale]));
  J.col(kTurnScale) = -half / turning_more * to_half;
  J(2, kTurnScale) = -1.0 / turning_more;
  J.col(kTurnPerMetre) = 0.5 * wheels.track_m / turning_more * to_half;
  return J;
}

}  // namespace waymark::calibrate
