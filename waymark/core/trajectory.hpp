#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/pose2.hpp"
#include "waymark/core/stamp.hpp"

namespace waymark {

/// Where the robot was at one moment, world frame; the covariance is in (x, y, theta) where it is known.
struct TrajectoryPoint {
  Stamp stamp;
  Pose2 pose;
  std::optional<Eigen::Matrix3d> covariance;
};

/// Points in the order of time.
using Trajectory = std::vector<TrajectoryPoint>;

}  // namespace waymark
