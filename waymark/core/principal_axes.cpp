#include "waymark/core/principal_axes.hpp"

#include <cmath>

namespace waymark {

PrincipalAxes principal_axes(const Eigen::Matrix2d& covariance) {
  const double mean = 0.5 * (covariance(0, 0) + covariance(1, 1));
  const double half_difference = 0.5 * (covariance(0, 0) - covariance(1, 1));
  const double spread = std::hypot(half_difference, covariance(0, 1));
  const double angle_rad = 0.5 * std::atan2(covariance(0, 1), half_difference);  // of the longer axis
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {{mean - spread, mean + spread}, Eigen::Matrix2d{{-s, c}, {c, s}}};
}

}  // namespace waymark
