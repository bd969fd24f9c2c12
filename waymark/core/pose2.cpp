#include "waymark/core/pose2.hpp"

namespace waymark {

Eigen::Matrix2d rotation_matrix(double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return Eigen::Matrix2d{{c, -s}, {s, c}};
}

Eigen::Matrix2d Pose2::rotation() const { return rotation_matrix(theta_rad); }

Pose2 Pose2::inverse() const {
  const Eigen::Vector2d p = -(rotation().transpose() * position());
  return {p.x(), p.y(), wrap_angle(-theta_rad)};
}

Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c) {
  const Eigen::Vector2d p = T_a_b * T_b_c.position();
  return {p.x(), p.y(), wrap_angle(T_a_b.theta_rad + T_b_c.theta_rad)};
}

Eigen::Vector2d operator*(const Pose2& T_a_b, const Eigen::Vector2d& p_b) {
  return T_a_b.rotation() * p_b + T_a_b.position();
}

Eigen::Matrix3d compose_jacobian_left(const Pose2& T_a_b, const Pose2& T_b_c) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F.block<2, 1>(0, 2) = perpendicular(T_a_b.rotation() * T_b_c.position());
  return F;
}

Eigen::Matrix3d compose_jacobian_right(const Pose2& T_a_b) {
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G.topLeftCorner<2, 2>() = T_a_b.rotation();
  return G;
}

Pose2 interpolate(const Pose2& a, const Pose2& b, double fraction) {
  const double turn_rad = wrap_angle(b.theta_rad - a.theta_rad);
  return {a.x_m + fraction * (b.x_m - a.x_m), a.y_m + fraction * (b.y_m - a.y_m),
          wrap_angle(a.theta_rad + fraction * turn_rad)};
}

Eigen::Vector3d difference(const Pose2& a, const Pose2& b) {
  return {a.x_m - b.x_m, a.y_m - b.y_m, wrap_angle(a.theta_rad - b.theta_rad)};
}

}  // namespace waymark
