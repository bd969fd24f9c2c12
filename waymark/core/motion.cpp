#include "waymark/core/motion.hpp"

#include <cmath>

namespace waymark {

bool is_finite(const Motion& motion) {
  const Pose2& T = motion.increment;
  return std::isfinite(T.x_m) && std::isfinite(T.y_m) && std::isfinite(T.theta_rad) &&
         motion.covariance.allFinite();
}

double travelled_m(const Motion& motion) {
  constexpr double kMetresPerRadian = 0.3;
  return motion.increment.position().norm() + kMetresPerRadian * std::abs(motion.increment.theta_rad);
}

PoseEstimate propagate(const PoseEstimate& before, const Motion& motion) {
  const Eigen::Matrix3d F = compose_jacobian_left(before.T_world_robot, motion.increment);
  const Eigen::Matrix3d G = compose_jacobian_right(before.T_world_robot);
  // Vincke (6)
  const Eigen::Matrix3d P = F * before.covariance * F.transpose() + G * motion.covariance * G.transpose();
  return {before.T_world_robot * motion.increment, 0.5 * (P + P.transpose())};
}

Motion compose(const Motion& first, const Motion& second) {
  const PoseEstimate both = propagate({first.increment, first.covariance}, second);
  return {both.T_world_robot, both.covariance, first.duration_s + second.duration_s};
}

}  // namespace waymark
