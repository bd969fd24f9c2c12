#pragma once

#include <span>
#include <string>
#include <vector>

#include "waymark/core/sensor_bias.hpp"

#include "workbench/run/config.hpp"

namespace waymark::smooth {

/// Something of the sensors that was estimated, under the config key which puts it in force.
struct CalibratedKey {
  std::string key;
  double value = 0.0;
  double sigma = 0.0;            ///< 0: goes with the others
  bool is_unobservable = false;  ///< the value is what was assumed
};

/// Those that have a key and whose certainty is known.
[[nodiscard]] std::vector<CalibratedKey> calibrated_keys(const CalibrationEstimate& estimate,
                                                         const Config& config);

/// Keys as a config file.
[[nodiscard]] std::string calibration_yaml(std::span<const CalibratedKey> keys);

/// What is known as a config file; of wheels, what their track would be.
[[nodiscard]] std::string calibration_yaml(const CalibrationEstimate& estimate, const Config& config);

}  // namespace waymark::smooth
