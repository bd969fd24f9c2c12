#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/pose2.hpp"
#include "waymark/models/odometry.hpp"

#include "workbench/sim/options.hpp"

namespace waymark::sim {

/// One arc of a path. No turn makes it a straight line, no distance a turn on the spot.
struct PathSegment {
  Pose2 T_world_start;
  ArcStep arc;

  /// The pose at `fraction` in [0, 1] of the way.
  [[nodiscard]] Pose2 at(double fraction) const;
  /// From a point of the world to the nearest point of the segment, m. Turns of at most one full circle.
  [[nodiscard]] double distance_m(const Eigen::Vector2d& p_world) const;
};

/// One lap: it ends in the pose in which it starts.
using Path = std::vector<PathSegment>;

/// The lap that the options describe, counter-clockwise about the origin where it has a sense. `seed` matters
/// to random paths only, which are drawn from the world's stream.
[[nodiscard]] Path make_path(const PathOptions& options, std::uint64_t seed);

/// Straight lines from corner to corner and back to the first. Each corner is an arc of the given radius, or
/// of the largest that leaves half of the shorter neighbouring side; zero: a turn on the spot. At least two
/// corners.
[[nodiscard]] Path polygon_path(const std::vector<Eigen::Vector2d>& corners, double corner_radius_m);

[[nodiscard]] double length_m(const Path& path);
[[nodiscard]] double distance_m(const Path& path, const Eigen::Vector2d& p_world);

}  // namespace waymark::sim
