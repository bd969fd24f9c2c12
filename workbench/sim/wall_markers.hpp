#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "workbench/sim/options.hpp"
#include "workbench/sim/path.hpp"

namespace waymark::sim {

/// A marker on a wall, seen from its front.
struct WallMarker {
  int number = 0;
  double size_m = 0.0;  ///< of the black square
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d along_s = Eigen::Vector3d::UnitX();  ///< unit vector to the right; down is -z

  /// Of the black square, clockwise from the upper left.
  [[nodiscard]] std::array<Eigen::Vector3d, 4> corners_m() const;
};

/// `markers` of the options, numbered from 0, in turn on the four walls of the hull and about evenly along
/// them, at the height of a robot's camera and somewhat above.
[[nodiscard]] std::vector<WallMarker> place_markers(const RoomOptions& options, const Path& path,
                                                    std::uint64_t seed);

}  // namespace waymark::sim
