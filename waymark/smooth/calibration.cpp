#include "waymark/smooth/calibration.hpp"

#include <cmath>

#include "waymark/models/odometry.hpp"
#include "waymark/models/odometry_errors.hpp"

namespace waymark::smooth {

Calibration calibration_sigmas(const SmoothOptions& options, const SensorErrors& errors, Observe observe) {
  Calibration sigmas;
  sigmas[kSpeedScale] = observes_scale(observe, errors) ? options.speed_scale_sigma : 0.0;
  sigmas[kTurnScale] = options.turn_scale_sigma;
  sigmas[kTurnBias] = to_radians(options.turn_bias_sigma_degps);
  sigmas[kTurnPerMetre] = to_radians(options.turn_per_m_sigma_deg);
  sigmas[kRangeScale] = errors.shared_range_sigma_ratio;
  sigmas[kRangeOffset] = errors.shared_range_sigma_m;
  sigmas[kBearingOffset] =
      to_radians(std::hypot(errors.shared_bearing_sigma_deg, options.mount_yaw_sigma_deg));
  sigmas[kMountX] = sigmas[kMountY] = options.mount_sigma_m;
  sigmas[kDelay] = options.delay_sigma_s;
  return sigmas;
}

CalibratedMotion calibrate(const Pose2& increment, double dt_s, const Calibration& c) {
  const double arc_m = arc_length_m(increment, ArcModel::kExact);
  const double missing_rad = c[kTurnBias] * dt_s + c[kTurnPerMetre] * arc_m;
  const CorrectedIncrement step = corrected(increment, 1.0, {c[kSpeedScale], c[kTurnScale], missing_rad});
  CalibratedMotion motion{step.increment};
  motion.J.col(kSpeedScale) = step.J.col(0);
  motion.J.col(kTurnScale) = step.J.col(1);
  motion.J.col(kTurnBias) = dt_s * step.J.col(2);
  motion.J.col(kTurnPerMetre) = arc_m * step.J.col(2);
  return motion;
}

CalibratedMotion compose(const CalibratedMotion& first, const CalibratedMotion& second) {
  return {first.increment * second.increment,
          compose_jacobian_left(first.increment, second.increment) * first.J +
              compose_jacobian_right(first.increment) * second.J};
}

}  // namespace waymark::smooth
