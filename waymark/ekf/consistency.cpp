#include "waymark/ekf/consistency.hpp"

#include <cmath>

#include "waymark/core/pose2.hpp"

namespace waymark::ekf {
namespace {

/// V(a): how a turn by a carries a displacement along.
Eigen::Matrix2d turn_jacobian(double a) {
  const double sine = std::abs(a) < 1e-6 ? 1.0 - a * a / 6.0 : std::sin(a) / a;
  const double versine = std::abs(a) < 1e-6 ? 0.5 * a : (1.0 - std::cos(a)) / a;
  return Eigen::Matrix2d{{sine, -versine}, {versine, sine}};
}

}  // namespace

Retraction::Retraction(Consistency consistency, double turn)
    : turns_(turns_the_ground(consistency)),
      V_(turns_ ? turn_jacobian(turn) : Eigen::Matrix2d(Eigen::Matrix2d::Identity())) {}

Eigen::Vector2d Retraction::shear(const Eigen::Vector2d& displacement) const {
  return turns_ ? perpendicular(displacement) : Eigen::Vector2d(Eigen::Vector2d::Zero());
}

}  // namespace waymark::ekf
