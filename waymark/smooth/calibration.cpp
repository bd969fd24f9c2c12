#include "waymark/smooth/calibration.hpp"

#include <cmath>

#include "waymark/models/odometry.hpp"

namespace waymark::smooth {
namespace {

/// k'(a) / k(a) of the chord ratio k(a) = sin(a/2) / (a/2).
double relative_chord_slope(double turn_rad) {
  if (std::abs(turn_rad) < 1e-3) return -turn_rad / 12.0;
  return 0.5 / std::tan(0.5 * turn_rad) - 1.0 / turn_rad;
}

}  // namespace

Calibration calibration_sigmas(const SmoothOptions& options, const SensorErrors& errors, Observe observe) {
  const bool trusts_ranges = observe != Observe::kBearing && !(errors.shared_range_sigma_ratio > 0.0);
  Calibration sigmas;
  sigmas << (trusts_ranges ? options.speed_scale_sigma : 0.0), options.turn_scale_sigma,
      to_radians(options.turn_bias_sigma_degps), errors.shared_range_sigma_ratio, errors.shared_range_sigma_m,
      to_radians(errors.shared_bearing_sigma_deg);
  return sigmas;
}

CalibratedMotion calibrate(const Pose2& increment, double dt_s, const Calibration& c) {
  if (increment == Pose2{}) return {};
  const double more_rad = c[kTurnScale] * increment.theta_rad + c[kTurnBias] * dt_s;
  const double longer = 1.0 + c[kSpeedScale];
  const Pose2 stretched{longer * increment.x_m, longer * increment.y_m, increment.theta_rad};
  CalibratedMotion motion{turned_more(stretched, more_rad, ArcModel::kExact)};
  const Eigen::Vector2d p = motion.increment.position();
  const double slope = relative_chord_slope(increment.theta_rad + more_rad);
  const Eigen::Vector3d to_turn(slope * p.x() - 0.5 * p.y(), slope * p.y() + 0.5 * p.x(), 1.0);
  motion.J.col(kSpeedScale) << p / longer, 0.0;
  motion.J.col(kTurnScale) = to_turn * increment.theta_rad;
  motion.J.col(kTurnBias) = to_turn * dt_s;
  return motion;
}

CalibratedMotion compose(const CalibratedMotion& first, const CalibratedMotion& second) {
  return {first.increment * second.increment,
          compose_jacobian_left(first.increment, second.increment) * first.J +
              compose_jacobian_right(first.increment) * second.J};
}

}  // namespace waymark::smooth
