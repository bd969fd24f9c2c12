#include "waymark/smooth/calibration.hpp"

#include "waymark/models/odometry_errors.hpp"

namespace waymark::smooth {

Calibration calibration_sigmas(const SmoothOptions& options, const SensorErrors& errors, Observe observe) {
  Calibration sigmas;
  sigmas << (tells_size(observe, errors) ? options.speed_scale_sigma : 0.0), options.turn_scale_sigma,
      to_radians(options.turn_bias_sigma_degps), errors.shared_range_sigma_ratio, errors.shared_range_sigma_m,
      to_radians(errors.shared_bearing_sigma_deg);
  return sigmas;
}

CalibratedMotion calibrate(const Pose2& increment, double dt_s, const Calibration& c) {
  static_assert(kSpeedScale == 0 && kTurnScale == 1 && kTurnBias == 2);
  const CorrectedIncrement step = corrected(increment, dt_s, c.head<3>());
  CalibratedMotion motion{step.increment};
  motion.J.leftCols<3>() = step.J;
  return motion;
}

CalibratedMotion compose(const CalibratedMotion& first, const CalibratedMotion& second) {
  return {first.increment * second.increment,
          compose_jacobian_left(first.increment, second.increment) * first.J +
              compose_jacobian_right(first.increment) * second.J};
}

}  // namespace waymark::smooth
