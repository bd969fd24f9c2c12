#include "waymark/association/grid_index.hpp"

#include <algorithm>
#include <bit>

namespace waymark {

void GridIndex::build(std::span<const Eigen::Vector2d> points) {
  points_.assign(points.begin(), points.end());
  const std::size_t buckets = std::bit_ceil(std::max<std::size_t>(2 * points.size(), 1));
  first_.assign(std::max(buckets, first_.size()), -1);
  next_.assign(points.size(), -1);
  cells_.resize(points.size());
  for (std::size_t i = points.size(); i-- > 0;) {
    cells_[i] = cell_of(points_[i]);
    int& first = first_[bucket(cells_[i])];
    next_[i] = first;
    first = static_cast<int>(i);
  }
}

/// Multiplicative hashing of both coordinates.
std::size_t GridIndex::bucket(const Cell& cell) const {
  const std::uint64_t mixed = static_cast<std::uint64_t>(cell.x) * 0x9E3779B97F4A7C15U ^
                              static_cast<std::uint64_t>(cell.y) * 0xC2B2AE3D27D4EB4FU;
  return static_cast<std::size_t>(mixed ^ (mixed >> 32)) & (first_.size() - 1);
}

}  // namespace waymark
