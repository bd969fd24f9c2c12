#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/event.hpp"
#include "waymark/core/stamp.hpp"
#include "waymark/models/odometry.hpp"

#include "workbench/sim/options.hpp"
#include "workbench/sim/path.hpp"

namespace waymark::sim {

/// From one odometry reading to the next.
struct DriveStep {
  Pose2 T_world_robot;  ///< the true pose in which the step begins
  ArcStep command;      ///< what the wheels really rolled
  Eigen::Vector3d slip =
      Eigen::Vector3d::Zero();  ///< (x, y, theta) beyond that, in the frame of the beginning
  WheelAngles counted;          ///< what the encoders made of it

  /// Where the robot is after `fraction` in [0, 1] of the step.
  [[nodiscard]] Pose2 at(double fraction) const;
};

/// What the robot really did, and what its encoders counted. It begins at stamp 0.
struct Drive {
  double rate_hz = 0.0;
  std::vector<DriveStep> steps;
  std::vector<std::size_t>
      corners;  ///< steps in whose beginning a corner is reached; steps.size() is the end

  [[nodiscard]] Stamp stamp(std::size_t step) const;
  [[nodiscard]] Stamp end() const { return stamp(steps.size()); }
  /// The true pose at any stamp from 0 to end().
  [[nodiscard]] Pose2 at(Stamp when) const;
};

/// Seconds that one lap takes: segments at constant speed or the largest turn rate, whichever takes longer,
/// and each in a whole number of odometry steps, so that a step is always one arc.
[[nodiscard]] double lap_duration_s(const Path& path, const SimOptions& options);

/// Drives the path. The wheels roll the arcs of the path plus a small correction whenever slip has carried
/// the robot away from it, as a robot with a perfect view of itself would; without slip it is on the path to
/// rounding. A robot that is carried (FaultOptions) is put down within one step, with its wheels at rest, and
/// finds back the same way. Wheels that slip in turns roll as planned, and the robot turns less, by a part
/// that is drawn for every turn.
[[nodiscard]] Drive drive(const Path& path, const SimOptions& options, std::uint64_t seed);

}  // namespace waymark::sim
