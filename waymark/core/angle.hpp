#pragma once

#include <cmath>
#include <numbers>

namespace waymark {

inline constexpr double kPi = std::numbers::pi;

/// The same direction in (-pi, pi]. NaN stays NaN.
[[nodiscard]] inline double wrap_angle(double angle_rad) {
  if (angle_rad > -kPi && angle_rad <= kPi) return angle_rad;
  const double wrapped = std::remainder(angle_rad, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

[[nodiscard]] constexpr double to_radians(double degrees) { return degrees * (kPi / 180.0); }
[[nodiscard]] constexpr double to_degrees(double radians) { return radians * (180.0 / kPi); }

}  // namespace waymark
