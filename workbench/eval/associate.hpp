#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/trajectory.hpp"

#include "workbench/eval/truth_track.hpp"

namespace waymark::eval {

/// An estimate beside the truth of the same moment. Both are of the point that the truth sensor measured, so
/// whatever follows can forget where on the robot that was.
struct PosePair {
  Stamp stamp;
  Pose2 estimate;  ///< T_world_sensor, in the frame of the estimate; heading of the robot
  std::optional<Eigen::Matrix3d> covariance;  ///< of `estimate` in (x, y, theta)
  Truth truth;                                ///< in the frame of the truth
};

struct AssociateOptions {
  Eigen::Vector2d truth_sensor_m = Eigen::Vector2d::Zero();  ///< where the truth was measured, robot frame
  Duration max_gap = std::chrono::seconds(1);  ///< longest hole of the estimate to interpolate over
};

/// One pair per truth stamp inside the time span of the estimate: the estimate is interpolated between its
/// neighbours (shorter turn) and carries the covariance of the earlier one. Where estimates share a stamp the
/// last one counts. Truth in holes of the estimate longer than `max_gap` is left out. O(n + m).
[[nodiscard]] std::vector<PosePair> associate(const Trajectory& estimate, const TruthTrack& truth,
                                              const AssociateOptions& options = {});

}  // namespace waymark::eval
