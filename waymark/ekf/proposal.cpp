#include "waymark/ekf/proposal.hpp"

namespace waymark::ekf {

Pose2 Proposal::pose() const {
  const Pose2 before = before_.pose().T_world_robot;
  const Eigen::Vector2d moved = retraction_.displacement({dx_[0], dx_[1]});
  return {before.x_m + moved.x(), before.y_m + moved.y(), wrap_angle(before.theta_rad + dx_[2])};
}

Eigen::Vector3d Proposal::landmark(int index) const {
  Eigen::Vector3d dx = increment(index);
  if (!before_.is_relative(index)) dx.head<2>() = retraction_.displacement(dx.head<2>());
  return before_.landmark(index) + dx;
}

Eigen::Vector2d Proposal::expected(const ErrorTerms& terms) const {
  return before_.expected(terms) + error_part(dx_, terms);
}

Eigen::Vector2d Proposal::explained(const Sighting& sighting) const {
  Eigen::Vector2d sum = sighting.H_pose * Eigen::Vector3d(dx_[0], dx_[1], dx_[2]) +
                        sighting.H_landmark * increment(sighting.landmark);
  if (sighting.anchor >= 0) sum += sighting.H_anchor * increment(sighting.anchor);
  if (sighting.second_anchor >= 0) sum += sighting.H_second_anchor * increment(sighting.second_anchor);
  return sum + error_part(dx_, sighting.errors);
}

/// What turning the increment dq of a point adds to the heading's column.
Eigen::Vector2d Proposal::turned(const Eigen::Matrix<double, 2, 3>& H, const Eigen::Vector2d& dq) const {
  return H.leftCols<2>() * perpendicular(retraction_.displacement(dq));
}

/// In the invariant filter the heading's column is taken about where the points stood, so that H leaves
/// turning everything unseen as it did before: what the step of Gauss and Newton would be with the exact
/// derivative of the increments would, over and over, learn a heading that nobody saw.
Sighting Proposal::moved_back(const Sighting& sighting) const {
  Sighting back = sighting;
  if (retraction_.turns()) {
    auto heading = back.H_pose.col(2);
    heading += turned(sighting.H_pose, {dx_[0], dx_[1]});
    if (!before_.is_relative(sighting.landmark))
      heading += turned(sighting.H_landmark, increment(sighting.landmark).head<2>());
    if (sighting.anchor >= 0) heading += turned(sighting.H_anchor, increment(sighting.anchor).head<2>());
    if (sighting.second_anchor >= 0)
      heading += turned(sighting.H_second_anchor, increment(sighting.second_anchor).head<2>());
  }
  back.nu += explained(back);
  return back;
}

}  // namespace waymark::ekf
