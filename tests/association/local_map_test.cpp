#include "waymark/association/local_map.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace waymark {
namespace {

constexpr LandmarkId kSeven{LandmarkId::Family::kMarker, 7};

Observation seen(double range_m, double bearing_rad, std::optional<LandmarkId> id = kSeven) {
  return {id, RangeBearing{range_m, bearing_rad}, Eigen::Matrix2d(Eigen::Vector2d(1e-4, 1e-4).asDiagonal())};
}

TEST(LocalMap, PlacesObservationsInTheRobotsFrame) {
  LocalMap map({.x_m = 0.5, .yaw_deg = 90.0});
  const ObservedLandmark* landmark = map.observe(*map.locate(seen(2.0, 0.0)));
  ASSERT_NE(landmark, nullptr);
  EXPECT_NEAR(landmark->p_robot.x(), 0.5, 1e-12);
  EXPECT_NEAR(landmark->p_robot.y(), 2.0, 1e-12);
}

TEST(LocalMap, MovesAgainstTheRobotAndGrowsLessSure) {
  LocalMap map({});
  map.observe(*map.locate(seen(3.0, 0.0)));
  const double before = map.find(kSeven)->covariance.trace();
  Motion motion{{1.0, 0.0, std::acos(0.0)}, Eigen::Matrix3d::Identity() * 1e-2, 0.1};
  map.predict(motion);
  EXPECT_NEAR(map.find(kSeven)->p_robot.x(), 0.0, 1e-9);
  EXPECT_NEAR(map.find(kSeven)->p_robot.y(), -2.0, 1e-9);
  // Position noise in both directions, and heading noise times the distance of 2 m.
  EXPECT_NEAR(map.find(kSeven)->covariance.trace(), before + 2e-2 + 4e-2, 1e-9);
}

TEST(LocalMap, TheLatestObservationStandsForAll) {
  LocalMap map({});
  map.observe(*map.locate(seen(3.0, 0.0)));
  map.observe(*map.locate(seen(2.0, 0.1)));
  ASSERT_EQ(map.landmarks().size(), 1U);
  EXPECT_EQ(map.landmarks()[0].times, 2);
  EXPECT_NEAR(map.landmarks()[0].p_robot.norm(), 2.0, 1e-12);
}

TEST(LocalMap, WithoutIdentityThePlaceDecides) {
  LocalMap map({});
  map.observe(*map.locate(seen(3.0, 0.0, std::nullopt)));
  map.observe(*map.locate(seen(3.01, 0.0, std::nullopt)));
  map.observe(*map.locate(seen(3.0, 1.0, std::nullopt)));
  EXPECT_EQ(map.landmarks().size(), 2U);
}

TEST(LocalMap, HasRoomForSoManyLandmarks) {
  LocalMap map({});
  for (int i = 0; i < 40; ++i)
    map.observe(*map.locate(seen(3.0, 0.0, LandmarkId{LandmarkId::Family::kMarker, i})));
  EXPECT_EQ(map.landmarks().size(), LocalMap::kCapacity);
  map.erase({LandmarkId::Family::kMarker, 3});
  EXPECT_EQ(map.find({LandmarkId::Family::kMarker, 3}), nullptr);
  EXPECT_NE(map.observe(*map.locate(seen(1.0, 0.0, LandmarkId{LandmarkId::Family::kMarker, 39}))), nullptr);
}

TEST(LocalMap, RangesAloneHaveNoPlace) {
  LocalMap map({});
  Observation range = seen(3.0, 0.0);
  range.value = Range{3.0};
  EXPECT_FALSE(map.locate(range));
  EXPECT_FALSE(map.locate({kSeven, RangeBearing{NAN, 0.0}, Eigen::Matrix2d::Identity()}));
  EXPECT_FALSE(map.locate({kSeven, RangeBearing{1.0, 0.0}, std::nullopt}));
}

}  // namespace
}  // namespace waymark
