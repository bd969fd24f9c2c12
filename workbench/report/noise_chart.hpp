#pragma once

#include <string>
#include <vector>

#include "workbench/calibrate/sensor_noise.hpp"

namespace waymark {

/// What a chart of errors over an axis is called, and by what numbers in SI are multiplied to be shown.
struct NoiseAxes {
  std::string title, note, x, y;
  double x_unit = 1.0;
  double y_unit = 1.0;
};

/// For the page of a sensor, as JSON: means and standard deviations of errors along an axis.
[[nodiscard]] std::string noise_chart_json(const NoiseAxes& axes,
                                           const std::vector<calibrate::NoiseBin>& bins);

/// The two charts of every sensor: errors of ranges by range, and of bearings by bearing.
[[nodiscard]] std::string noise_charts_json(const std::vector<calibrate::NoiseBin>& ranges,
                                            const std::vector<calibrate::NoiseBin>& bearings);

}  // namespace waymark
