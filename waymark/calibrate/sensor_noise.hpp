#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "waymark/slam/config.hpp"
#include "waymark/smooth/smoother.hpp"

namespace waymark::calibrate {

/// An estimate and its standard deviation.
struct Value {
  double value = 0.0;
  double sigma = 0.0;
};

/// How large errors are at about this place on an axis (a range, m, or a bearing, rad).
struct NoiseBin {
  double at = 0.0;
  int count = 0;
  double mean = 0.0;  ///< of what was measured less what was true
  Value sigma;        ///< standard deviation of the measurement's errors
};

/// Noise that grows along a line with the range.
struct RangeNoise {
  Value sigma_m;      ///< at range zero
  Value sigma_ratio;  ///< more per metre
};

/// A straight line through the standard deviations of bins, by least squares; neither part is negative.
[[nodiscard]] std::optional<RangeNoise> fit_range_noise(const std::vector<NoiseBin>& bins);

/// What the sightings of a log say of their noise.
struct SensorNoise {
  std::optional<RangeNoise> range;
  std::optional<Value> bearing_sigma_deg;
  std::vector<NoiseBin> ranges;    ///< errors of ranges, by range
  std::vector<NoiseBin> bearings;  ///< errors of bearings, by bearing
  int outliers = 0;                ///< left out: beyond 4 standard deviations
  int runs = 0;
  bool settled = false;
  std::string input;
  Config before;
  std::vector<std::string> notes;
};

/// Noise from what is left over of sightings by the whole log, in bins of equally many: R is the mean of
/// r r^T plus what the estimate followed, H P H^T (the innovation matching of Mehra 1970, by the smoothed
/// estimate).
[[nodiscard]] SensorNoise noise_of(const std::vector<smooth::SmoothedSighting>& sightings);

/// Finds the noise of ranges and bearings of a sensor that moves among landmarks, vibration included, by what
/// is left over; again with what was found until that settles. `keep_going` as in record(); false stops.
[[nodiscard]] Result<SensorNoise> calibrate_noise(const std::string& input, const UserSettings& user,
                                                  const std::function<bool(double)>& keep_going = {});

/// As a config that puts in force what was found.
[[nodiscard]] std::string to_yaml(const SensorNoise& noise);

}  // namespace waymark::calibrate
