#include "waymark/ekf/recall.hpp"

namespace waymark::ekf {

Recall::Recall(const State& active, const CompressedTerms& since, PassiveSubmap& passive,
               const std::vector<int>& members, std::size_t capacity)
    : active_(active),
      since_(since),
      passive_(passive),
      members_(members),
      base_(static_cast<Eigen::Index>(capacity), active.dimension()),
      minus_psi_base_(base_.rows(), base_.cols()),
      cross_(base_.rows(), base_.cols()) {}

/// What the submap's corrections did to a landmark, whose columns are in base_ afterwards.
Eigen::Vector3d Recall::displacement(int slot, const Retraction& retraction) {
  const auto n = static_cast<Eigen::Index>(active_.size());
  passive_.columns(slot, members_, base_.topRows(n));
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  moved.head(active_.dimension()).noalias() =
      base_.topRows(n).transpose() * Eigen::Map<const Eigen::VectorXd>(since_.tau(), n);
  moved.head<2>() = retraction.displacement(moved.head<2>());
  return moved;
}

Eigen::Vector3d Recall::position(int slot) {
  const Eigen::Vector3d moved = displacement(slot, retraction());
  return passive_.position(slot) + moved;
}

Recall::Landmark Recall::landmark(int slot) {
  const Retraction turned = retraction();
  const Eigen::Vector3d moved = displacement(slot, turned);
  Eigen::Vector3d shear = Eigen::Vector3d::Zero();
  shear.head<2>() = turned.shear(moved.head<2>());
  Eigen::Matrix3d covariance = passive_.covariance(slot);
  const int dimension = active_.dimension();
  const auto n = static_cast<Eigen::Index>(active_.size());
  for (int a = 0; a < dimension; ++a) {
    since_.multiply_phi(base_.col(a).head(n), cross_.col(a).head(n));
    since_.multiply_minus_psi(base_.col(a).head(n), minus_psi_base_.col(a).head(n));
    cross_.col(a).head<2>() += active_.deferred() * cross_(2, a);
  }
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  c.head(dimension) = cross_.row(2);
  covariance.topLeftCorner(dimension, dimension).noalias() +=
      base_.topRows(n).transpose().lazyProduct(minus_psi_base_.topRows(n));
  covariance +=
      shear * c.transpose() + c * shear.transpose() + active_.covariance(2, 2) * shear * shear.transpose();
  for (Eigen::Index i = 0; i < n; ++i)
    cross_.row(i) += active_.covariance(static_cast<std::size_t>(i), 2) * shear.head(dimension).transpose();
  return {passive_.position(slot) + moved,
          shear,
          covariance,
          base_.topRows(n),
          minus_psi_base_.topRows(n),
          cross_.topRows(n)};
}

/// P(row, :) J^T for the robot and the errors that something depends on.
Eigen::Vector2d Recall::correlation(std::size_t row, const SparseJacobian& jacobian) const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (Eigen::Index k = 0; k < jacobian.head; ++k)
    sum += active_.covariance(row, jacobian.rows[static_cast<std::size_t>(k)]) * jacobian.J.col(k).head<2>();
  return sum;
}

Eigen::Matrix2d Recall::innovation_covariance(int slot, const LinearizedObservation& linearization) {
  const Landmark now = landmark(slot);
  const SparseJacobian head(linearization.H_pose, linearization.errors);
  const auto H_landmark = linearization.H_landmark.leftCols(active_.dimension());
  Eigen::Matrix2d S =
      linearization.R + linearization.H_landmark * now.covariance * linearization.H_landmark.transpose();
  for (Eigen::Index k = 0; k < head.head; ++k) {
    const std::size_t row = head.rows[static_cast<std::size_t>(k)];
    const Eigen::Vector2d J = head.J.col(k).head<2>();
    const Eigen::Matrix2d cross = J * (cross_.row(static_cast<Eigen::Index>(row)) * H_landmark.transpose());
    S += J * correlation(row, head).transpose() + cross + cross.transpose();
  }
  return S;
}

Eigen::Matrix<double, 3, 2> Recall::pose_correlation(int slot, const LinearizedObservation& linearization) {
  (void)landmark(slot);
  const SparseJacobian head(linearization.H_pose, linearization.errors);
  Eigen::Matrix<double, 3, 2> C =
      cross_.topRows<3>() * linearization.H_landmark.leftCols(active_.dimension()).transpose();
  for (int i = 0; i < 3; ++i) C.row(i) += correlation(static_cast<std::size_t>(i), head).transpose();
  return C;
}

}  // namespace waymark::ekf
