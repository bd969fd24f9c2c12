#include "workshop/figures/line_chart.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace waymark {

std::string to_svg(const LineChart& chart) {
  constexpr double kLeft = 40.0, kTop = 22.0, kWidth = 275.0, kHeight = 135.0;
  const double highest = std::max(1e-9, *std::ranges::max_element(chart.values));
  std::string line;
  for (std::size_t i = 0; i < chart.values.size(); ++i)
    line +=
        fmt::format("{:.1f},{:.1f} ",
                    kLeft + kWidth * static_cast<double>(i) / static_cast<double>(chart.values.size() - 1),
                    kTop + kHeight * (1.0 - chart.values[i] / highest));
  return fmt::format(
      "<text x=\"{0}\" y=\"14\" fill=\"#222\">{4}</text>"
      "<rect x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{3}\" fill=\"none\" stroke=\"#bbb\"/>"
      "<g fill=\"#555\" font-size=\"11\"><text x=\"{5}\" y=\"{6}\" text-anchor=\"end\">{7:.4g}</text>"
      "<text x=\"{5}\" y=\"{8}\" text-anchor=\"end\">0</text><text x=\"{0}\" y=\"{9}\">0</text>"
      "<text x=\"{10}\" y=\"{9}\" text-anchor=\"end\">{11}</text></g>"
      "<polyline points=\"{12}\" fill=\"none\" stroke=\"#1f6fb4\" stroke-width=\"1.2\"/>\n",
      kLeft, kTop, kWidth, kHeight, chart.title, kLeft - 4.0, kTop + 9.0, highest, kTop + kHeight,
      kTop + kHeight + 14.0, kLeft + kWidth, chart.values.size() - 1, line);
}

}  // namespace waymark
