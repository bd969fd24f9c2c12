#include "workbench/eval/space_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

#include "waymark/core/angle.hpp"

namespace waymark::eval {
namespace {

constexpr double kStep_m = 0.02;  // as in travelled_m()

Eigen::Vector3d centre_of(const SpacePath& path) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const SpacePose& pose : path) sum += pose.p_m;
  return sum / static_cast<double>(path.size());
}

/// Principal axes of the positions, of the smallest spread first, and their variances.
Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal_axes(const SpacePath& path) {
  const Eigen::Vector3d centre = centre_of(path);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const SpacePose& pose : path) sum += (pose.p_m - centre) * (pose.p_m - centre).transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum / static_cast<double>(path.size()));
}

/// Twice the area that the path sweeps about its centre, along its normal.
Eigen::Vector3d swept(const SpacePath& path) {
  const Eigen::Vector3d centre = centre_of(path);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i - 1].p_m - centre).cross(path[i].p_m - centre);
  return sum;
}

Eigen::Matrix3d with_rows(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& z) {
  Eigen::Matrix3d R;
  R << x.transpose(), y.transpose(), z.transpose();
  return R;
}

Eigen::Matrix3d onto_fitted_plane(const SpacePath& path) {
  if (path.empty()) return Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d axes = principal_axes(path).eigenvectors();
  Eigen::Vector3d normal = axes.col(0);
  if (normal.dot(swept(path)) < 0.0) normal = -normal;
  const Eigen::Vector3d x = axes.col(2);
  return with_rows(x, normal.cross(x), normal);
}

/// The body's x axis, or y where x is nearer to the normal of the plane than to it.
int heading_axis(const SpacePath& path, const Eigen::Matrix3d& R) {
  if (path.empty()) return 0;
  const Eigen::Vector3d x = R * path.front().q.toRotationMatrix().col(0);
  return x.head<2>().norm() < std::abs(x.z()) ? 1 : 0;
}

/// Where the world's z axis points, seen from the body: it stays while the body turns about it.
Eigen::Vector3d up_of(const SpacePose& pose) { return pose.q.conjugate() * Eigen::Vector3d::UnitZ(); }

SpacePose pose_in_space(Stamp stamp, const Pose2& pose) {
  return {stamp,
          {pose.x_m, pose.y_m, 0.0},
          Eigen::Quaterniond(Eigen::AngleAxisd(pose.theta_rad, Eigen::Vector3d::UnitZ()))};
}

}  // namespace

OutOfPlane out_of_plane(const SpacePath& path) {
  OutOfPlane out;
  if (path.empty()) return out;
  const auto [low, high] = std::ranges::minmax(path, {}, [](const SpacePose& pose) { return pose.p_m.z(); });
  out.height_m = high.p_m.z() - low.p_m.z();
  const Eigen::Vector3d up = up_of(path.front());
  Eigen::Vector3d last = path.front().p_m;
  for (const SpacePose& pose : path) {
    out.tilt_rad = std::max(out.tilt_rad, std::atan2(up.cross(up_of(pose)).norm(), up.dot(up_of(pose))));
    const double step_m = (pose.p_m - last).norm();
    if (step_m < kStep_m) continue;
    out.length_m += step_m;
    last = pose.p_m;
  }
  return out;
}

bool is_planar(const OutOfPlane& out) {
  constexpr double kShare = 0.01;
  const double max_tilt_rad = to_radians(5.0);
  return out.height_m <= std::max(kStep_m, kShare * out.length_m) && out.tilt_rad <= max_tilt_rad;
}

std::optional<Plane> plane_named(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, Plane>, 4> kPlanes{
      {{"xy", Plane::kXy}, {"xz", Plane::kXz}, {"yz", Plane::kYz}, {"fit", Plane::kFit}}};
  for (const auto& [known, plane] : kPlanes)
    if (known == name) return plane;
  return std::nullopt;
}

Eigen::Matrix3d onto_plane(Plane plane, const SpacePath& path) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  switch (plane) {
    case Plane::kXy:
      return with_rows(x, y, z);
    case Plane::kXz:
      return with_rows(x, z, -y);
    case Plane::kYz:
      return with_rows(y, z, x);
    case Plane::kFit:
      return onto_fitted_plane(path);
  }
  return Eigen::Matrix3d::Identity();
}

Trajectory on_plane(const SpacePath& path, const Eigen::Matrix3d& R) {
  const int axis = heading_axis(path, R);
  Trajectory trajectory;
  trajectory.reserve(path.size());
  for (const SpacePose& pose : path) {
    const Eigen::Vector3d p = R * pose.p_m;
    const Eigen::Vector3d ahead = R * pose.q.toRotationMatrix().col(axis);
    trajectory.push_back({pose.stamp, {p.x(), p.y(), std::atan2(ahead.y(), ahead.x())}, std::nullopt});
  }
  return trajectory;
}

SpacePath in_space(const Trajectory& path) {
  SpacePath space;
  space.reserve(path.size());
  for (const TrajectoryPoint& point : path) space.push_back(pose_in_space(point.stamp, point.pose));
  return space;
}

SpacePath in_space(const TruthTrack& track) {
  SpacePath space;
  space.reserve(track.samples().size());
  for (const auto& [stamp, truth] : track.samples())
    space.push_back(pose_in_space(stamp, {truth.x_m, truth.y_m, truth.theta_rad.value_or(0.0)}));
  return space;
}

bool has_orientation(const SpacePath& path) {
  constexpr double kStraight = 0.1;  // spread across over spread along, of an arc of 45 degrees
  const auto is_first = [&](const SpacePose& pose) { return pose.q.coeffs() == path.front().q.coeffs(); };
  if (path.size() < 3 || !std::ranges::all_of(path, is_first)) return true;
  const Eigen::Vector3d variances = principal_axes(path).eigenvalues();
  const bool stands = variances[2] < kStep_m * kStep_m;
  return stands || std::sqrt(std::max(variances[1], 0.0)) < kStraight * std::sqrt(variances[2]);
}

}  // namespace waymark::eval
