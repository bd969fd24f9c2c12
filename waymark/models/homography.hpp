#pragma once

#include <array>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace waymark {

/// A place on a plane, and where it is seen.
struct PlacePair {
  Eigen::Vector2d from, to;
};

/// The homography H, H(2, 2) = 1, that takes (x, y, 1) of `from` to `to`: least squares over scaled points
/// (Hartley and Zisserman, "Multiple View Geometry", algorithm 4.2). Nothing for fewer than four pairs, or
/// places on a line.
[[nodiscard]] std::optional<Eigen::Matrix3d> homography(std::span<const PlacePair> pairs);

}  // namespace waymark
