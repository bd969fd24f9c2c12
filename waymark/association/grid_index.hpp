#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace waymark {

/// Points of the plane in square cells, to find those near a place. Memory is taken as the number of points
/// grows and kept.
class GridIndex {
 public:
  explicit GridIndex(double cell_m) : cell_m_(cell_m) {}

  /// O(n).
  void build(std::span<const Eigen::Vector2d> points);

  /// Calls visit(index) once for every point within `radius_m`, in an order that depends on the points alone.
  /// Looks at the cells about the place, or at all points where those are fewer.
  template <class Visit>
  void visit_near(const Eigen::Vector2d& p, double radius_m, const Visit& visit) const {
    const auto visit_if_near = [&](int i) {
      if ((points_[static_cast<std::size_t>(i)] - p).squaredNorm() <= radius_m * radius_m) visit(i);
    };
    const double cells_across = 2.0 * radius_m / cell_m_ + 2.0;
    if (!(cells_across * cells_across < static_cast<double>(points_.size()))) {
      for (int i = 0; i < static_cast<int>(points_.size()); ++i) visit_if_near(i);
      return;
    }
    const Cell low = cell_of(p.array() - radius_m);
    const Cell high = cell_of(p.array() + radius_m);
    for (std::int64_t y = low.y; y <= high.y; ++y)
      for (std::int64_t x = low.x; x <= high.x; ++x)
        for (int i = first_[bucket({x, y})]; i >= 0; i = next_[static_cast<std::size_t>(i)])
          if (cells_[static_cast<std::size_t>(i)] == Cell{x, y}) visit_if_near(i);
  }

 private:
  struct Cell {
    std::int64_t x = 0;
    std::int64_t y = 0;
    friend bool operator==(const Cell&, const Cell&) = default;
  };

  [[nodiscard]] Cell cell_of(const Eigen::Vector2d& p) const { return {cell_of(p.x()), cell_of(p.y())}; }
  /// What is not a number, too, is somewhere. std::floor would be a call on processors without SSE 4.1.
  [[nodiscard]] std::int64_t cell_of(double x_m) const {
    constexpr double kFarthest = 1e15;
    const double cells = x_m / cell_m_;
    const double bounded = cells >= -kFarthest ? std::min(cells, kFarthest) : -kFarthest;
    const auto towards_zero = static_cast<std::int64_t>(bounded);
    return towards_zero - (static_cast<double>(towards_zero) > bounded ? 1 : 0);
  }
  [[nodiscard]] std::size_t bucket(const Cell& cell) const;

  double cell_m_;
  std::vector<Eigen::Vector2d> points_;
  std::vector<Cell> cells_;  // of the points
  std::vector<int> first_;   // of the points in a bucket; a power of two of them
  std::vector<int> next_;    // behind a point in its bucket
};

}  // namespace waymark
