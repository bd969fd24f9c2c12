#pragma once

#include <Eigen/Core>

#include "waymark/core/pose2.hpp"
#include "waymark/core/random.hpp"

namespace waymark::test {

inline Eigen::Vector3d to_vector(const Pose2& pose) { return {pose.x_m, pose.y_m, pose.theta_rad}; }
inline Pose2 to_pose(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// Position in a square of `extent_m` about the origin, any heading.
inline Pose2 random_pose(RandomStream& random, double extent_m = 10.0) {
  const double half_m = 0.5 * extent_m;
  return {random.uniform(-half_m, half_m), random.uniform(-half_m, half_m), random.uniform(-kPi, kPi)};
}

/// A positive definite matrix with entries of about `scale`.
template <int N>
Eigen::Matrix<double, N, N> random_covariance(RandomStream& random, double scale = 1.0) {
  Eigen::Matrix<double, N, N> root;
  for (auto& entry : root.reshaped()) entry = random.normal();
  return scale * (root * root.transpose() + 0.1 * Eigen::Matrix<double, N, N>::Identity());
}

}  // namespace waymark::test
