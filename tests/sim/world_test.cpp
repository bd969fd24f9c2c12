#include "workbench/sim/world.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace waymark::sim {
namespace {

Path square() { return make_path({}, 1); }

TEST(World, LandmarksKeepTheirDistanceFromThePath) {
  const WorldOptions options{.landmarks = 200, .min_offset_m = 1.0, .max_offset_m = 2.5, .separation_m = 0.2};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const TrueLandmark& landmark : place_landmarks(options, square(), seed)) {
      const double offset_m = distance_m(square(), {landmark.x_m, landmark.y_m});
      EXPECT_GE(offset_m, 1.0);
      EXPECT_LE(offset_m, 2.5 + 1e-12);
    }
  }
}

TEST(World, LandmarksStandOnBothSides) {
  int inside = 0;
  for (const TrueLandmark& landmark : place_landmarks({}, square(), 1)) {
    if (std::abs(landmark.x_m) < 3.0 && std::abs(landmark.y_m) < 3.0) ++inside;
  }
  EXPECT_GT(inside, 0);
  EXPECT_LT(inside, 24);
}

TEST(World, AForestStandsAllOverItsSquareButNotInTheWay) {
  const WorldOptions options{
      .landmarks = 400, .spread = Spread::kArea, .area_m = 30.0, .min_offset_m = 0.5, .separation_m = 0.5};
  const auto landmarks = place_landmarks(options, square(), 1);
  ASSERT_EQ(landmarks.size(), 400u);
  std::array<int, 4> quarters{};
  for (const TrueLandmark& landmark : landmarks) {
    EXPECT_LE(std::max(std::abs(landmark.x_m), std::abs(landmark.y_m)), 15.0);
    EXPECT_GE(distance_m(square(), {landmark.x_m, landmark.y_m}), 0.5);
    ++quarters[(landmark.x_m > 0.0 ? 1U : 0U) + (landmark.y_m > 0.0 ? 2U : 0U)];
  }
  // Five standard deviations of a quarter of 400.
  for (const int count : quarters) EXPECT_NEAR(count, 100, 5.0 * std::sqrt(400 * 0.25 * 0.75));
}

TEST(World, ASquareThatThePathFillsStillTakesLandmarks) {
  const WorldOptions options{.landmarks = 50, .spread = Spread::kArea, .area_m = 2.0, .min_offset_m = 20.0};
  EXPECT_EQ(place_landmarks(options, square(), 1).size(), 50u);
}

TEST(World, LandmarksAreNumberedFromZero) {
  const auto landmarks = place_landmarks({}, square(), 1);
  ASSERT_EQ(landmarks.size(), 24u);
  for (std::int32_t i = 0; i < 24; ++i) {
    EXPECT_EQ(landmarks[static_cast<std::size_t>(i)].id, (LandmarkId{LandmarkId::Family::kMarker, i}));
  }
}

TEST(World, LandmarksAreApart) {
  const auto landmarks = place_landmarks({}, square(), 1);
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GE(std::hypot(landmarks[i].x_m - landmarks[j].x_m, landmarks[i].y_m - landmarks[j].y_m), 0.5);
    }
  }
}

TEST(World, SeparationYieldsWhereThereIsNoRoom) {
  const WorldOptions options{
      .landmarks = 500, .min_offset_m = 1.0, .max_offset_m = 1.2, .separation_m = 100.0};
  EXPECT_EQ(place_landmarks(options, square(), 1).size(), 500u);
}

TEST(World, FollowsItsSeed) {
  EXPECT_EQ(place_landmarks({}, square(), 1)[3].x_m, place_landmarks({}, square(), 1)[3].x_m);
  EXPECT_NE(place_landmarks({}, square(), 1)[3].x_m, place_landmarks({}, square(), 2)[3].x_m);
}

}  // namespace
}  // namespace waymark::sim
