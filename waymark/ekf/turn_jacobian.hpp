#pragma once

#include <cmath>

#include <Eigen/Core>

namespace waymark::ekf {

/// V(a): how a turn by a carries a displacement along (the left Jacobian of SO(2)).
[[nodiscard]] inline Eigen::Matrix2d turn_jacobian(double a) {
  const double sine = std::abs(a) < 1e-6 ? 1.0 - a * a / 6.0 : std::sin(a) / a;
  const double versine = std::abs(a) < 1e-6 ? 0.5 * a : (1.0 - std::cos(a)) / a;
  return Eigen::Matrix2d{{sine, -versine}, {versine, sine}};
}

}  // namespace waymark::ekf
