#include "workbench/sim/path.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"

namespace waymark::sim {
namespace {

PathOptions shaped(Shape shape, double corner_radius_m = 0.0) {
  PathOptions options;
  options.shape = shape;
  options.corner_radius_m = corner_radius_m;
  return options;
}

void expect_near(const Pose2& a, const Pose2& b, double tolerance) {
  EXPECT_LT(difference(a, b).cwiseAbs().maxCoeff(), tolerance);
}

class EveryShape : public testing::TestWithParam<std::tuple<Shape, double>> {
 protected:
  [[nodiscard]] static Path path(std::uint64_t seed) {
    const auto [shape, corner_radius_m] = GetParam();
    return make_path(shaped(shape, corner_radius_m), seed);
  }
};

TEST_P(EveryShape, IsClosedAndConnected) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Path lap = path(seed);
    for (std::size_t i = 0; i < lap.size(); ++i) {
      expect_near(lap[i].at(1.0), lap[(i + 1) % lap.size()].T_world_start, 1e-9);
    }
  }
}

TEST_P(EveryShape, StartsAwayFromTheOriginAndStaysInItsSquare) {
  const Path lap = path(3);
  EXPECT_GT(lap.front().T_world_start.position().norm(), 0.5);
  for (const PathSegment& segment : lap) {
    for (double f = 0.0; f <= 1.0; f += 0.05)
      EXPECT_LE(segment.at(f).position().cwiseAbs().maxCoeff(), 3.0 + 1e-9);
  }
}

// The closed formula against the least distance to many points of the segment.
TEST_P(EveryShape, DistanceIsThatToTheNearestPoint) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (const PathSegment& segment : path(4)) {
    const double x_m = random.uniform(-5.0, 5.0);
    const Eigen::Vector2d p(x_m, random.uniform(-5.0, 5.0));
    double nearest_m = 1e9;
    for (int i = 0; i <= 20000; ++i)
      nearest_m = std::min(nearest_m, (segment.at(i / 20000.0).position() - p).norm());
    EXPECT_LE(segment.distance_m(p), nearest_m + 1e-12);
    EXPECT_NEAR(segment.distance_m(p), nearest_m, 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryShape,
                         testing::Combine(testing::Values(Shape::kSquare, Shape::kLShape, Shape::kFigureEight,
                                                          Shape::kRandom, Shape::kLoop),
                                          testing::Values(0.0, 0.5)));

TEST(Path, LengthsAreThoseOfTheShapes) {
  EXPECT_DOUBLE_EQ(length_m(make_path(shaped(Shape::kSquare), 1)), 24.0);
  EXPECT_DOUBLE_EQ(length_m(make_path(shaped(Shape::kLShape), 1)), 24.0);
  EXPECT_DOUBLE_EQ(length_m(make_path(shaped(Shape::kFigureEight), 1)), 6.0 * kPi);
  EXPECT_NEAR(length_m(make_path(shaped(Shape::kSquare, 0.5), 1)), 24.0 - 8 * 0.5 + 2.0 * kPi * 0.5, 1e-12);
}

TEST(Path, SquareTurnsLeftOnTheSpotInItsCorners) {
  const Path square = make_path(shaped(Shape::kSquare), 1);
  ASSERT_EQ(square.size(), 8u);
  EXPECT_EQ(square[1].arc.distance_m, 0.0);
  EXPECT_NEAR(square[1].arc.turn_rad, kPi / 2.0, 1e-12);
}

TEST(Path, CornerTooWideForItsSidesIsNarrowed) {
  const Path square = make_path(shaped(Shape::kSquare, 50.0), 1);
  ASSERT_EQ(square.size(), 4u);  // a circle: nothing is left of the sides
  EXPECT_NEAR(length_m(square), 6.0 * kPi, 1e-9);
}

TEST(Path, RandomPathFollowsItsSeed) {
  const PathOptions options = shaped(Shape::kRandom);
  EXPECT_EQ(make_path(options, 5).front().T_world_start, make_path(options, 5).front().T_world_start);
  EXPECT_NE(make_path(options, 5).front().T_world_start, make_path(options, 6).front().T_world_start);
}

}  // namespace
}  // namespace waymark::sim
