#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace waymark {

/// The value below which this part of the values lies, without interpolation; 0 of no values. O(n).
[[nodiscard]] inline double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0.0;
  const auto place =
      std::min(values.size() - 1, static_cast<std::size_t>(part * static_cast<double>(values.size())));
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace waymark
