#include "waymark/models/odometry_errors.hpp"

#include <cmath>

#include "waymark/models/odometry.hpp"

namespace waymark {
namespace {

/// k'(a) / k(a) of the chord ratio k(a) = sin(a/2) / (a/2).
double relative_chord_slope(double turn_rad) {
  if (std::abs(turn_rad) < 1e-3) return -turn_rad / 12.0;
  return 0.5 / std::tan(0.5 * turn_rad) - 1.0 / turn_rad;
}

}  // namespace

CorrectedIncrement corrected(const Pose2& increment, double dt_s, const OdometryErrors& errors) {
  if (increment == Pose2{}) return {};
  const double more_rad = errors[1] * increment.theta_rad + errors[2] * dt_s;
  const double longer = 1.0 + errors[0];
  const Pose2 stretched{longer * increment.x_m, longer * increment.y_m, increment.theta_rad};
  CorrectedIncrement motion{turned_more(stretched, more_rad, ArcModel::kExact)};
  const Eigen::Vector2d p = motion.increment.position();
  const double slope = relative_chord_slope(increment.theta_rad + more_rad);
  const Eigen::Vector3d to_turn(slope * p.x() - 0.5 * p.y(), slope * p.y() + 0.5 * p.x(), 1.0);
  motion.J.col(0) << p / longer, 0.0;
  motion.J.col(1) = to_turn * increment.theta_rad;
  motion.J.col(2) = to_turn * dt_s;
  return motion;
}

}  // namespace waymark
