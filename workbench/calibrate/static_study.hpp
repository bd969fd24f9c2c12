#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "workbench/calibrate/sensor_noise.hpp"

namespace waymark::calibrate {

/// A recording of a landmark at a place that somebody has measured, from the sensor and its axis.
struct StaticPlace {
  std::string log;
  double range_m = 0.0;
  double bearing_rad = 0.0;
  std::optional<int> id;  ///< of the landmark, where others are in view
};

/// Reads a table "log,range_m,bearing_deg" with or without a column "id"; logs are named from its folder.
[[nodiscard]] Result<std::vector<StaticPlace>> read_places(const std::filesystem::path& file);

/// What was seen of the landmark at one place.
struct PlaceStudy {
  StaticPlace place;
  int scans = 0;
  int observations = 0;
  double range_error_m = 0.0;  ///< mean of what was measured less what is true
  double bearing_error_rad = 0.0;
  Eigen::Matrix2d covariance =
      Eigen::Matrix2d::Zero();  ///< of one observation about that mean: range m, bearing rad

  /// In half of the scans or more.
  [[nodiscard]] bool is_usable() const { return 2 * observations >= scans && observations > 1; }
};

/// The end of what can be used on one side: the last place that can, if one beyond it cannot.
struct SensorLimits {
  std::optional<double> min_range_m, max_range_m;
  std::optional<double> left_rad, right_rad;  ///< bearings; left is positive
};

/// What recordings at known places say of a sensor.
struct StaticStudy {
  std::vector<PlaceStudy> places;
  std::optional<Value> range_scale;  ///< where places at three distances or more tell it from an offset
  Value range_offset_m;
  Value bearing_offset_rad;
  Value range_scatter_m;  ///< standard deviation of a place's mean error from what scale and offset say
  Value bearing_scatter_rad;
  std::optional<RangeNoise>
      range;  ///< of one observation at a place that was not studied: repetition and scatter
  Value bearing_sigma_rad;
  SensorLimits limits;
  Config before;
  std::vector<std::string> notes;
};

/// From what was seen at each place: errors by least squares over the places, which count alike however many
/// observations they have, since a sensor repeats at one place what is wrong there. At least two places that
/// can be used.
[[nodiscard]] Result<StaticStudy> study_of(std::vector<PlaceStudy> places);

/// Reads all recordings. Images are searched for markers. `keep_going` as in record(); false stops.
[[nodiscard]] Result<StaticStudy> study_places(const std::vector<StaticPlace>& places,
                                               const UserSettings& user,
                                               const std::function<bool(double)>& keep_going = {});

/// As a config that puts in force what was found; biases only where they are twice their standard deviation.
[[nodiscard]] std::string to_yaml(const StaticStudy& study);

}  // namespace waymark::calibrate
