#pragma once

#include <Eigen/Core>

namespace waymark::ekf {

/// At which point the filter linearises, which decides whether it fools itself about its heading.
enum class Consistency {
  kInvariant,  ///< right-invariant error (Barrau and Bonnabel 2015) in ordinary coordinates: a shear after
               ///< each update
  kFej,        ///< first-estimates Jacobians (Huang, Mourikis, Roumeliotis 2010)
  kStandard,   ///< at the latest estimate, as in the 2012 article; overconfident when the odometry is poor
};

/// Whether Jacobians are taken at the first estimate of everything, and not at the latest one.
[[nodiscard]] constexpr bool linearizes_at_first_estimates(Consistency consistency) {
  return consistency == Consistency::kFej;
}

/// Whether a correction of the heading turns the ground along, about the origin of the world: the mean by
/// Retraction, the covariance by Shear.
[[nodiscard]] constexpr bool turns_the_ground(Consistency consistency) {
  return consistency == Consistency::kInvariant;
}

/// How a correction dx moves points on the ground: by what dx says, or in the invariant filter by V(a) of
/// that, with a the change of heading and V the left Jacobian of SO(2).
class Retraction {
 public:
  /// For a change of heading of `turn` rad.
  Retraction(Consistency consistency, double turn);

  [[nodiscard]] bool turns() const { return turns_; }
  /// Displacement (x, y) of a ground point whose increment in dx is dq.
  [[nodiscard]] Eigen::Vector2d displacement(const Eigen::Vector2d& dq) const { return V_ * dq; }
  /// d of a ground point that is moved so, a part of the covariance's shear P <- (I + d e_theta^T) P (I + d
  /// e_theta^T)^T. Zero where there is none.
  [[nodiscard]] Eigen::Vector2d shear(const Eigen::Vector2d& displacement) const;

 private:
  bool turns_;
  Eigen::Matrix2d V_;
};

}  // namespace waymark::ekf
