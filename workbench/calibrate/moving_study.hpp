#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "workbench/calibrate/findings.hpp"
#include "workbench/calibrate/sensor_noise.hpp"

namespace waymark::calibrate {

/// What the log of a robot that moves among landmarks says of the sensor that sees them.
struct MovingStudy {
  std::string input;
  SensorNoise noise;
  std::vector<CalibrationFinding> findings;  ///< noise and delay under the keys that put them in force
  /// Standard deviations of the odometry in x, y and theta against what the config says.
  std::array<Value, 3> odometry_noise{Value{1.0}, Value{1.0}, Value{1.0}};
  int runs = 0;
  bool settled = false;  ///< the last run found what it was run with
  std::vector<std::string> notes;
};

/// Finds the noise of ranges and bearings, vibration included, and how late the sensor is, by what is left
/// over when path, map and the noise of the odometry are estimated from the whole log; again with what was
/// found until that settles. Of markers in images it finds the noise in pixels and the shaking of the
/// camera. Observations count once per place (smooth.keyframe_*): seen again from there, a landmark shows the
/// same error. `keep_going` as in record(); false stops.
[[nodiscard]] Result<MovingStudy> study_moving(const std::string& input, const UserSettings& user,
                                               const std::function<bool(double)>& keep_going = {});

/// As a config that puts in force what was found.
[[nodiscard]] std::string to_yaml(const MovingStudy& study);

}  // namespace waymark::calibrate
