#pragma once

#include <Eigen/Core>

#include "waymark/core/pose2.hpp"
#include "waymark/core/sensor_bias.hpp"
#include "waymark/models/observe.hpp"
#include "waymark/smooth/options.hpp"

namespace waymark::smooth {

/// Standard deviations before the log was seen; 0: is not estimated. The scale of distances is so only
/// against ranges that can be trusted: else nothing would tell a large world from a small one.
[[nodiscard]] Calibration calibration_sigmas(const SmoothOptions& options, const SensorErrors& errors,
                                             Observe observe);

/// What an increment of the odometry was by a calibration, and d(x, y, theta)/d(calibration).
struct CalibratedMotion {
  Pose2 increment;
  Eigen::Matrix<double, 3, kCalibrationSize> J = Eigen::Matrix<double, 3, kCalibrationSize>::Zero();
};

/// One step that took so long: the same arc, longer and turning more. One that stands stays.
[[nodiscard]] CalibratedMotion calibrate(const Pose2& increment, double dt_s, const Calibration& calibration);

/// One motion after the other.
[[nodiscard]] CalibratedMotion compose(const CalibratedMotion& first, const CalibratedMotion& second);

}  // namespace waymark::smooth
