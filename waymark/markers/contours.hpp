#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "waymark/markers/local_contrast.hpp"

namespace waymark::markers {

/// A closed line, its last point next to its first.
using Contour = std::vector<Eigen::Vector2f>;

/// Follows where a contrast map crosses zero, to parts of a pixel: marching squares (Lorensen and Cline
/// 1987), the crossing between two neighbours by linear interpolation, two dark corners across joined where
/// the mean of all four is dark.
class ContourTracer {
 public:
  /// Hands every contour of at least `points_min` points to `use`, which may keep it only until it returns,
  /// in the order of their first rows: clockwise in the image around what is dark, counter-clockwise around
  /// what is bright in it.
  void trace(const ContrastMap& map, std::size_t points_min, const std::function<void(const Contour&)>& use);

 private:
  void find_starts(const ContrastMap& map, int v);
  void follow(const ContrastMap& map, int u, int v);

  std::vector<std::uint8_t> starts_;   ///< of one row: a bright pixel left of a dark one
  std::vector<std::uint8_t> is_done_;  ///< of the map: there a contour passes that was followed
  Contour contour_;
};

}  // namespace waymark::markers
