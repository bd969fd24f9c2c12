#pragma once

#include <Eigen/Core>

#include "waymark/core/sensor_bias.hpp"
#include "waymark/models/odometry.hpp"

namespace waymark::calibrate {

/// The wheels with the scales of distance and turn taken in: with scales of 1 they make the same motion.
[[nodiscard]] WheelGeometry with_scales(const OdometryOptions& odometry);

/// What a calibration says of wheels. Its turning per metre is a difference of the radii.
[[nodiscard]] WheelGeometry corrected(const WheelGeometry& wheels, const Calibration& calibration);

/// The calibration by which `corrected` makes one pair of wheels of another; zero but for speed and turn
/// scale and turning per metre.
[[nodiscard]] Calibration deviation(const WheelGeometry& from, const WheelGeometry& to);

/// Derivatives of the logarithms of left and right radius and track in `corrected` to the calibration.
[[nodiscard]] Eigen::Matrix<double, 3, kCalibrationSize> log_jacobian(const WheelGeometry& wheels,
                                                                      const Calibration& calibration);

}  // namespace waymark::calibrate
