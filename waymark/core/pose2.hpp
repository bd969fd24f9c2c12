#pragma once

#include <Eigen/Core>

#include "waymark/core/angle.hpp"

namespace waymark {

/// A rigid motion of the plane, SE(2): x forward, y left, heading counter-clockwise from above.
/// `T_a_b` maps coordinates in b to coordinates in a; names cancel in products: T_a_b * T_b_c = T_a_c.
struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double theta_rad = 0.0;  ///< in (-pi, pi] for every pose that a function here returns

  friend bool operator==(const Pose2&, const Pose2&) = default;

  [[nodiscard]] Eigen::Vector2d position() const { return {x_m, y_m}; }
  [[nodiscard]] Eigen::Matrix2d rotation() const;
  [[nodiscard]] Pose2 inverse() const;
};

/// J = [[0,-1],[1,0]]: turns a vector by +90 degrees; d R(a)/da = J R(a).
[[nodiscard]] inline Eigen::Vector2d perpendicular(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }
[[nodiscard]] Eigen::Matrix2d rotation_matrix(double angle_rad);

[[nodiscard]] Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c);
[[nodiscard]] Eigen::Vector2d operator*(const Pose2& T_a_b, const Eigen::Vector2d& p_b);

/// d(T_a_b * T_b_c)/d(T_a_b) and /d(T_b_c), each 3x3 in (x, y, theta).
[[nodiscard]] Eigen::Matrix3d compose_jacobian_left(const Pose2& T_a_b, const Pose2& T_b_c);
[[nodiscard]] Eigen::Matrix3d compose_jacobian_right(const Pose2& T_a_b);

/// The pose at `fraction` in [0, 1] of the way from a to b: straight line, shorter turn.
[[nodiscard]] Pose2 interpolate(const Pose2& a, const Pose2& b, double fraction);

/// (dx, dy, wrapped dtheta) = a - b, coordinate by coordinate.
[[nodiscard]] Eigen::Vector3d difference(const Pose2& a, const Pose2& b);

}  // namespace waymark
