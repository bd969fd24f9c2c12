#include "waymark/ekf/belief.hpp"

namespace waymark::ekf {

Belief::Belief(const StateLayout& layout, int capacity, Consistency consistency)
    : layout_(layout),
      consistency_(consistency),
      x_(layout.offset(capacity)),
      first_(layout.offset(capacity)),
      relative_(static_cast<std::size_t>(capacity), 0),
      P_(layout.size(), layout.offset(capacity)) {}

Eigen::Matrix3d Belief::landmark_covariance(int index) const {
  Eigen::Matrix3d P_landmark = Eigen::Matrix3d::Zero();
  const std::size_t first = offset(index);
  for (int a = 0; a < dimension(); ++a)
    for (int b = 0; b < dimension(); ++b)
      P_landmark(a, b) = P_(first + static_cast<std::size_t>(a), first + static_cast<std::size_t>(b));
  return P_landmark;
}

Eigen::Matrix2d Belief::innovation_covariance(const LinearizedObservation& linearized) const {
  return common_covariance(linearized, linearized) + linearized.R;  // Vincke (11)
}

Eigen::Matrix2d Belief::common_covariance(const LinearizedObservation& a,
                                          const LinearizedObservation& b) const {
  const SparseJacobian t = layout_.jacobian(a, 2);
  const SparseJacobian u = layout_.jacobian(b, 2);
  Eigen::Matrix2d common = Eigen::Matrix2d::Zero();
  for (Eigen::Index i = 0; i < t.J.cols(); ++i) {
    const Eigen::Vector2d J_a = t.J.col(i).head<2>();
    for (Eigen::Index j = 0; j < u.J.cols(); ++j) {
      const Eigen::Vector2d part =
          P_(t.rows[static_cast<std::size_t>(i)], u.rows[static_cast<std::size_t>(j)]) * J_a;
      common.col(0) += part * u.J(0, j);
      common.col(1) += part * u.J(1, j);
    }
  }
  return common;
}

Eigen::Matrix<double, 3, 2> Belief::pose_correlation(const LinearizedObservation& linearized) const {
  const SparseJacobian t = layout_.jacobian(linearized, 2);
  Eigen::Matrix<double, 3, 2> C = Eigen::Matrix<double, 3, 2>::Zero();
  for (int i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < t.J.cols(); ++j)
      C.row(i) +=
          P_(static_cast<std::size_t>(i), t.rows[static_cast<std::size_t>(j)]) * t.J.col(j).transpose();
  return C;
}

Eigen::VectorXd Belief::mean() const {
  Eigen::VectorXd x(3 + dimension() * landmarks());  // Vincke (1)
  for (int i = 0; i < x.size(); ++i) x[i] = x_[layout_.row(i)];
  return x;
}

Eigen::MatrixXd Belief::covariance() const {
  const int n = 3 + dimension() * landmarks();
  Eigen::MatrixXd full(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) full(i, j) = P_(layout_.row(i), layout_.row(j));  // Vincke (2)
  return full;
}

}  // namespace waymark::ekf
