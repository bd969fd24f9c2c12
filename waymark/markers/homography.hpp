#pragma once

#include <optional>

#include <Eigen/Core>

#include "waymark/markers/corners.hpp"

namespace waymark::markers {

/// The homography H, H(2, 2) = 1, that takes (x, y, 1) of a square about the origin, x to the right and y
/// down, to the four given points, clockwise from the upper left. Nothing where they do not span a
/// quadrangle.
[[nodiscard]] std::optional<Eigen::Matrix3d> homography_of_square(const Corners& points, double side);

/// The upper left, upper right, lower right and lower left corner of that square.
[[nodiscard]] Corners corners_of_square(double side);

}  // namespace waymark::markers
