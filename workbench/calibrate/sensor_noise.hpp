#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "workbench/run/smoother.hpp"

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

/// A straight line through the standard deviations of bins, by least squares; neither part is negative, and
/// where the slope is less than twice its standard deviation there is none.
[[nodiscard]] std::optional<RangeNoise> fit_range_noise(const std::vector<NoiseBin>& bins);

/// By how much variances are larger than stated.
struct VarianceFactor {
  double value = 1.0;
  double redundancy = 0.0;  ///< how many errors that rests on: what was not followed of them
  double stated = 0.0;      ///< mean of the variances stated
};

/// What the observations of a log say of their noise.
struct SensorNoise {
  std::optional<RangeNoise> range;
  std::optional<Value> bearing_sigma_rad;
  std::vector<NoiseBin> ranges;    ///< errors of ranges, by range
  std::vector<NoiseBin> bearings;  ///< errors of bearings, by bearing
  VarianceFactor range_variance, bearing_variance;
  int outliers = 0;  ///< left out: beyond 4 standard deviations of what is left over
};

/// Noise from what is left over of observations by the whole log, in bins of equally many: variances are as
/// many times larger than stated as the squares of what is left over are larger than the redundancies 1 - H P
/// H^T / R (Foerstner 1979). What was stated is to be replaced by this until it stays: then R is the mean of
/// r r^T plus what was followed (the innovation matching of Mehra 1970, by the smoothed estimate).
[[nodiscard]] SensorNoise noise_of(const std::vector<smooth::SmoothedObservation>& observations);

/// By how much variances of the odometry, in x, y and theta, are larger than stated; likewise.
[[nodiscard]] std::array<VarianceFactor, 3> odometry_variance_of(
    const std::vector<smooth::IntervalResidual>& intervals);

}  // namespace waymark::calibrate
