#pragma once

#include <Eigen/Core>

#include "waymark/core/motion.hpp"
#include "waymark/ekf/covariance.hpp"
#include "waymark/ekf/sparse_jacobian.hpp"

namespace waymark::ekf {

/// A motion of the robot, (3) and (6) of Vincke et al. 2012: where it leads, and how errors of the pose and
/// of the increment go into that. Nothing but the robot moves.
class Prediction {
 public:
  /// Jacobians are taken between `linearized_at`, for the pose before the motion, and the pose after it.
  Prediction(const Pose2& T_world_robot, const Pose2& linearized_at, const Pose2& increment);

  [[nodiscard]] const Pose2& pose() const { return after_; }
  /// P <- F P F^T + G Q G^T: P_rr at once, P_rm when it is next needed. O(1).
  void apply(Covariance& P, const Eigen::Matrix3d& Q) const;
  /// Where the increment depends on biases e as `errors` say, d(increment)/de: what these have in
  /// common with the state becomes the robot's as well. After apply(). O(n).
  void spread(Covariance& P, const BiasTerms& errors) const;

 private:
  Pose2 after_;
  Eigen::Vector2d phi_;  // F = [I, phi; 0, 1]
  Eigen::Matrix3d G_;    // d(pose after)/d(increment)
};

}  // namespace waymark::ekf
