#include "workbench/eval/map_placement.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "eval/eval_support.hpp"

namespace waymark::eval {
namespace {

/// A robot that moves by so much to and fro and is located to 1 mm.
std::vector<PosePair> shuffling(double by_m) {
  RandomStream random = test::random_stream(11);
  std::vector<PosePair> pairs;
  for (int i = 0; i < 200; ++i) {
    const double x_m = by_m * std::sin(0.3 * i);
    pairs.push_back({stamp_from_seconds(0.1 * i),
                     {x_m + 0.001 * random.normal(), 0.001 * random.normal(), 0.0},
                     std::nullopt,
                     {x_m, 0.0, 0.0}});
  }
  return pairs;
}

FitAngle angle_of(const std::vector<PosePair>& pairs) { return fit_angle(pairs, *fit_path(pairs)); }

TEST(FitAngle, IsTheErrorOfThePositionsOverTheirSpread) {
  const FitAngle angle = angle_of(shuffling(1.0));
  EXPECT_NEAR(angle.spread_m, 1.0 / std::sqrt(2.0), 0.02);
  EXPECT_NEAR(angle.sigma_m, 0.001, 2e-4);
  EXPECT_NEAR(angle.sigma_rad, angle.sigma_m / angle.spread_m, 1e-12);
  EXPECT_TRUE(std::isinf(angle_of(shuffling(0.0)).sigma_rad)) << "true positions that do not spread";
}

bool placed_by_start(double by_m, double reach_m, AnchorHeading heading = AnchorHeading::kTruth) {
  const auto pairs = shuffling(by_m);
  const std::vector<LandmarkEstimate> map{{.position_m = {reach_m, 0.0, 0.0}},
                                          {.position_m = {0.0, reach_m, 0.0}}};
  StartAlignment start = *anchor_at_start(pairs);
  start.heading = heading;
  return start_places_map(pairs, map, start, angle_of(pairs));
}

TEST(StartPlacesMap, WhereTheAngleOfAShortPathWouldMoveItMoreThanThePathIsOff) {
  EXPECT_TRUE(placed_by_start(0.0, 3.0));
  EXPECT_TRUE(placed_by_start(0.05, 3.0));
  EXPECT_TRUE(placed_by_start(0.05, 3.0, AnchorHeading::kNone));
  EXPECT_FALSE(placed_by_start(1.0, 3.0));
  EXPECT_FALSE(placed_by_start(0.05, 0.1)) << "landmarks are as near as the path is long";
  EXPECT_FALSE(placed_by_start(0.05, 3.0, AnchorHeading::kPath)) << "the start takes its angle from the path";
}

}  // namespace
}  // namespace waymark::eval
