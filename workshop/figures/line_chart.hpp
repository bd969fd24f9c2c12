#pragma once

#include <string>
#include <vector>

namespace waymark {

/// Values over 0, 1, 2, ...: 320 x 180 of SVG with the range of both axes.
struct LineChart {
  std::string title;
  std::vector<double> values;
};

[[nodiscard]] std::string to_svg(const LineChart& chart);

}  // namespace waymark
