#pragma once

#include <array>

#include <Eigen/Core>

namespace waymark::markers {

/// The corners of a marker's black square, clockwise from the upper left of its pattern, px; the centre of
/// the first pixel is at (0, 0).
using Corners = std::array<Eigen::Vector2d, 4>;

/// Of (u, v) of the four corners in their order.
using CornerCovariance = Eigen::Matrix<double, 8, 8>;

/// Corners, and how well they are known.
struct RefinedCorners {
  Corners corners_px;
  /// For points on the sides that are each off by 1 px (standard deviation): neighbours share a side.
  CornerCovariance covariance;
};

}  // namespace waymark::markers
