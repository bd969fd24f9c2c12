#include "workbench/report/rounded.hpp"

#include <cmath>

namespace waymark {

double rounded(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  const double places = 5.0 - std::floor(std::log10(std::abs(value)));
  // A power of ten is exact only where its exponent is not below 0.
  const double power = std::pow(10.0, std::abs(places));
  if (places < 0.0) return std::round(value / power) * power;
  return std::isfinite(power) ? std::round(value * power) / power : 0.0;
}

}  // namespace waymark
