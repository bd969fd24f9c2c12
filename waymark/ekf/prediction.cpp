#include "waymark/ekf/prediction.hpp"

namespace waymark::ekf {

// F's heading column is J times the displacement between the points of linearisation.
Prediction::Prediction(const Pose2& T_world_robot, const Pose2& linearized_at, const Pose2& increment)
    : after_(T_world_robot * increment),  // Vincke (3)
      phi_(perpendicular(after_.position() - linearized_at.position())),
      G_(compose_jacobian_right(linearized_at)) {}

void Prediction::apply(Covariance& P, const Eigen::Matrix3d& Q) const {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F.block<2, 1>(0, 2) = phi_;
  const Eigen::Matrix3d P_rr = F * P.block<3>(0) * F.transpose() + G_ * Q * G_.transpose();  // Vincke (6)
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = i; j < 3; ++j) P.row(i)[j] = P_rr(static_cast<int>(i), static_cast<int>(j));
  P.defer_to_robot_rows(phi_);
}

/// With A = G d(increment)/de and P_re as F leaves it: P_rm += A P_em, P_rr += A P_er + P_re A^T + A P_ee
/// A^T.
void Prediction::spread(Covariance& P, const BiasTerms& errors) const {
  P.propagate_cross_covariance();
  const SparseJacobian t(Eigen::Matrix3d::Zero(), errors);
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d own = cross;
  for (Eigen::Index i = 3; i < t.J.cols(); ++i) {
    const Eigen::Vector3d a = G_ * t.J.col(i);
    const std::size_t row = t.rows[static_cast<std::size_t>(i)];
    cross += a * Eigen::RowVector3d(P(0, row), P(1, row), P(2, row));
    for (Eigen::Index j = 3; j < t.J.cols(); ++j)
      own += P(row, t.rows[static_cast<std::size_t>(j)]) * a * (G_ * t.J.col(j)).transpose();
  }
  const Eigen::Matrix3d more = cross + cross.transpose() + own;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = i; j < 3; ++j) P.row(i)[j] += more(static_cast<int>(i), static_cast<int>(j));
  for (std::size_t j = 3; j < P.size(); ++j) {
    Eigen::Vector3d column = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 3; i < t.J.cols(); ++i)
      column += P(t.rows[static_cast<std::size_t>(i)], j) * t.J.col(i);
    column = (G_ * column).eval();
    for (std::size_t i = 0; i < 3; ++i) P.row(i)[j] += column[static_cast<int>(i)];
  }
}

}  // namespace waymark::ekf
