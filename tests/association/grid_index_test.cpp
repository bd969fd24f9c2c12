#include "waymark/association/grid_index.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"

namespace waymark {
namespace {

using Points = std::vector<Eigen::Vector2d>;

std::vector<int> near(const GridIndex& grid, const Eigen::Vector2d& p, double radius_m) {
  std::vector<int> found;
  grid.visit_near(p, radius_m, [&](int i) { found.push_back(i); });
  std::ranges::sort(found);
  return found;
}

std::vector<int> near_by_search(const Points& points, const Eigen::Vector2d& p, double radius_m) {
  std::vector<int> found;
  for (std::size_t i = 0; i < points.size(); ++i)
    if ((points[i] - p).norm() <= radius_m) found.push_back(static_cast<int>(i));
  return found;
}

TEST(GridIndex, FindsWhatASearchOfAllPointsFinds) {
  RandomStream random(1, StreamPurpose::kWorld);
  GridIndex grid(2.0);
  for (const int count : {300, 1, 40, 500}) {
    Points points;
    for (int i = 0; i < count; ++i) {
      const double x_m = random.uniform(-40.0, 40.0);
      points.emplace_back(x_m, random.uniform(-40.0, 40.0));
    }
    grid.build(points);
    for (const double radius_m : {0.1, 1.0, 3.0, 15.0, 200.0}) {
      const Eigen::Vector2d p(random.uniform(-50.0, 50.0), random.uniform(-50.0, 50.0));
      EXPECT_EQ(near(grid, p, radius_m), near_by_search(points, p, radius_m)) << count << ' ' << radius_m;
    }
  }
}

TEST(GridIndex, AnEmptyOneFindsNothing) {
  GridIndex grid(1.0);
  grid.build({});
  EXPECT_TRUE(near(grid, {0.0, 0.0}, 10.0).empty());
}

TEST(GridIndex, WhatIsNotFiniteIsNowhereNear) {
  GridIndex grid(1.0);
  Points points(50, {1.0, 1.0});
  points[7] = {std::numeric_limits<double>::quiet_NaN(), 1.0};
  points[8] = {std::numeric_limits<double>::infinity(), 1.0};
  grid.build(points);
  EXPECT_EQ(near(grid, {1.0, 1.0}, 0.5).size(), 48u);
}

}  // namespace
}  // namespace waymark
