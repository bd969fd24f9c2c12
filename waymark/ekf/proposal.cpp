#include "waymark/ekf/proposal.hpp"

namespace waymark::ekf {

Proposal Proposal::with_indices_of(const Slots& map) const {
  Proposal proposal = *this;
  proposal.map_ = &map;
  return proposal;
}

Pose2 Proposal::pose() const {
  const Pose2 before = before_.pose().T_world_robot;
  const Eigen::Vector2d moved = retraction_.displacement({dx_[0], dx_[1]});
  return {before.x_m + moved.x(), before.y_m + moved.y(), wrap_angle(before.theta_rad + dx_[2])};
}

Eigen::Vector3d Proposal::landmark(int index) const {
  Eigen::Vector3d dx = increment(index);
  if (!before_.is_relative(local(index))) dx.head<2>() = retraction_.displacement(dx.head<2>());
  return before_.landmark(local(index)) + dx;
}

Eigen::Vector2d Proposal::expected(const BiasTerms& terms) const {
  return before_.expected(terms) + bias_part(dx_, terms);
}

Eigen::Vector2d Proposal::explained(const LinearizedObservation& linearization) const {
  Eigen::Vector2d sum = linearization.H_pose * Eigen::Vector3d(dx_[0], dx_[1], dx_[2]) +
                        linearization.H_landmark * increment(linearization.landmark);
  if (linearization.anchor >= 0) sum += linearization.H_anchor * increment(linearization.anchor);
  if (linearization.second_anchor >= 0)
    sum += linearization.H_second_anchor * increment(linearization.second_anchor);
  return sum + bias_part(dx_, linearization.errors);
}

/// What turning the increment dq of a point adds to the heading's column.
Eigen::Vector2d Proposal::turned(const Eigen::Matrix<double, 2, 3>& H, const Eigen::Vector2d& dq) const {
  return H.leftCols<2>() * perpendicular(retraction_.displacement(dq));
}

/// In the invariant filter the heading's column is taken about where the points stood, so that H leaves
/// turning everything unseen as it did before: what the step of Gauss and Newton would be with the exact
/// derivative of the increments would, over and over, learn a heading that nobody saw.
LinearizedObservation Proposal::relinearized_to_prior(const LinearizedObservation& linearization) const {
  LinearizedObservation back = linearization;
  if (retraction_.turns()) {
    auto heading = back.H_pose.col(2);
    heading += turned(linearization.H_pose, {dx_[0], dx_[1]});
    if (!before_.is_relative(local(linearization.landmark)))
      heading += turned(linearization.H_landmark, increment(linearization.landmark).head<2>());
    if (linearization.anchor >= 0)
      heading += turned(linearization.H_anchor, increment(linearization.anchor).head<2>());
    if (linearization.second_anchor >= 0)
      heading += turned(linearization.H_second_anchor, increment(linearization.second_anchor).head<2>());
  }
  back.nu += explained(back);
  return back;
}

}  // namespace waymark::ekf
