#pragma once

#include <cmath>

#include "workbench/eval/space_path.hpp"

namespace waymark::eval::test {

/// A path on a floor, in another plane of its frame.
inline SpacePath in_plane(Plane plane, SpacePath path) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  if (plane == Plane::kFit)
    R = Eigen::AngleAxisd(1.0, Eigen::Vector3d(0.6, -0.2, 0.3).normalized()).toRotationMatrix();
  else
    R = onto_plane(plane, path).transpose();
  for (SpacePose& pose : path) {
    pose.p_m = R * pose.p_m;
    pose.q = Eigen::Quaterniond(R) * pose.q;
  }
  return path;
}

/// The path on a hill of this height.
inline SpacePath lifted(SpacePath path, double height_m) {
  for (std::size_t i = 0; i < path.size(); ++i)
    path[i].p_m.z() += 0.5 * height_m * (1.0 - std::cos(0.1 * static_cast<double>(i)));
  return path;
}

}  // namespace waymark::eval::test
