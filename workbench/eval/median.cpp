#include "workbench/eval/median.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace waymark::eval {

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double robust_sigma(std::vector<double> error_lengths) {
  if (error_lengths.size() < 2) return 0.0;
  const double few = 1.0 + 5.0 / (2.0 * static_cast<double>(error_lengths.size()) - 3.0);
  return few * *median(std::move(error_lengths)) / std::sqrt(2.0 * std::numbers::ln2);
}

}  // namespace waymark::eval
