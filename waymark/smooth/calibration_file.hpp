#pragma once

#include <string>
#include <vector>

#include "waymark/core/gaussian.hpp"
#include "waymark/slam/config.hpp"
#include "waymark/smooth/calibration.hpp"

namespace waymark::smooth {

/// What was learnt of the sensors, as deviations from what the config says.
struct CalibrationEstimate {
  Calibration mean = Calibration::Zero();
  Calibration sigmas = Calibration::Zero();  ///< 0: was not estimated
};

/// What a filter says of its odometry: Filter::odometry_errors().
[[nodiscard]] CalibrationEstimate calibration_of(const Gaussian<3>& odometry);

/// Something of the sensors that was estimated, under the config key which puts it in force.
struct CalibratedKey {
  std::string key;
  double value = 0.0;
  double sigma = 0.0;
};

/// Those that have a key and whose certainty is known.
[[nodiscard]] std::vector<CalibratedKey> calibrated_keys(const CalibrationEstimate& estimate,
                                                         const Config& config);

/// The same as a config file; what has no key stands in a comment.
[[nodiscard]] std::string calibration_yaml(const CalibrationEstimate& estimate, const Config& config);

}  // namespace waymark::smooth
