#pragma once

#include <optional>
#include <string_view>

#include <Eigen/Core>

#include "waymark/core/trajectory.hpp"

#include "workbench/eval/truth_track.hpp"
#include "workbench/logs/trajectory_file.hpp"

namespace waymark::eval {

/// How far a path leaves the plane that it is scored in.
struct OutOfPlane {
  double length_m = 0.0;  ///< of the path, steps below 2 cm gathered first (travelled_m())
  double height_m = 0.0;  ///< from its lowest pose to its highest
  double tilt_rad = 0.0;  ///< largest change of roll and pitch since its first pose
};

/// Of the plane x-y. O(n).
[[nodiscard]] OutOfPlane out_of_plane(const SpacePath& path);

/// The heights of a path on a floor: at most 1 % of its length, and 2 cm in any case. Its tilt stays below 5
/// degrees: up to there the heading is wrong by less than tilt^2 / 4, which is 0.1 degrees.
[[nodiscard]] bool is_planar(const OutOfPlane& out);

/// Planes that a path may be scored in: those of its axes, or fitted to it.
enum class Plane { kXy, kXz, kYz, kFit };

/// "xy", "xz", "yz" or "fit".
[[nodiscard]] std::optional<Plane> plane_named(std::string_view name);

/// The rotation that turns a plane of `path` onto x-y. That of xz has z to the left of x, that of yz z to the
/// left of y. The fitted plane is that of least squares, seen from where the path runs counter-clockwise, so
/// that two views of one path are not mirrored.
[[nodiscard]] Eigen::Matrix3d onto_plane(Plane plane, const SpacePath& path);

/// The path in the plane, without covariances: `R` from onto_plane(). Its heading is that of the body's x
/// axis, or of y where the body turns about x.
[[nodiscard]] Trajectory on_plane(const SpacePath& path, const Eigen::Matrix3d& R);

/// A planar path as one in space. Headings that were not measured are 0.
[[nodiscard]] SpacePath in_space(const Trajectory& path);
[[nodiscard]] SpacePath in_space(const TruthTrack& track);

/// The orientation was measured: it changes, or the path is straight. A path that turns with one orientation
/// in all rows was written by a program that had none.
[[nodiscard]] bool has_orientation(const SpacePath& path);

}  // namespace waymark::eval
