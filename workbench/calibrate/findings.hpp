#pragma once

#include <string>
#include <vector>

#include "waymark/slam/odometer.hpp"

#include "workbench/run/calibration_file.hpp"
#include "workbench/run/config.hpp"
#include "workbench/run/smoother.hpp"

namespace waymark::calibrate {

/// Something about the robot that was estimated, in the units in which its odometry is told.
struct CalibrationFinding {
  smooth::CalibratedKey found;
  double before = 0.0;  ///< what the config said
  bool is_key = true;   ///< else it follows from others, and no config has it
};

/// Of a key that is a number.
[[nodiscard]] double value_of(const Config& config, const std::string& key);

/// What a smoothed run with the config `during` says of its sensors: of wheels their radii and their track,
/// of other odometry its scales and how it turns by itself; mount and ranges where they were estimated.
/// `before` is the config that holds without this.
[[nodiscard]] std::vector<CalibrationFinding> findings(const smooth::Smoothed& smoothed, const Config& during,
                                                       const Config& before, OdometryKind odometry);

/// As a config: everything, with the scales that are in the wheels already set to 1.
[[nodiscard]] std::vector<smooth::CalibratedKey> keys_of(const std::vector<CalibrationFinding>& findings);

/// The calibration of a run with the config `during` that leads to the config `to`.
[[nodiscard]] Calibration deviation(const Config& during, const Config& to, OdometryKind odometry);

}  // namespace waymark::calibrate
