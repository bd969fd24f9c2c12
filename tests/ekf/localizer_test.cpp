#include "waymark/ekf/localizer.hpp"

#include <gmock/gmock.h>

#include "support/circle_world.hpp"
#include "waymark/core/gaussian.hpp"

namespace waymark {
namespace {

using test::CircleWorld;

MapState map_of(CircleWorld& world) {
  EkfSlam filter({.capacity = 20}, {}, world.mount());
  for (int i = 0; i < 100; ++i) {
    filter.predict(world.move());
    filter.correct(world.look());
  }
  return filter.save();
}

/// One landmark after the other, as a slow reader has it.
void drive(Filter& filter, CircleWorld& world, int steps) {
  for (int i = 0; i < steps; ++i) {
    filter.predict(world.move());
    const Observation seen = world.sight((3 * i) % 8);
    filter.correct({&seen, 1});
  }
}

TEST(Localizer, FindsItselfWithinTheFirstSightingsAndStaysThere) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CircleWorld world(seed);
    Localizer filter(map_of(world), {}, {}, world.mount());
    drive(filter, world, 2);
    EXPECT_FALSE(filter.knows_pose());
    drive(filter, world, 18);
    ASSERT_TRUE(filter.knows_pose());
    drive(filter, world, 80);
    EXPECT_LT((filter.pose().T_world_robot.position() - world.truth().position()).norm(), 0.3);
    EXPECT_EQ(filter.losses(), 0);
  }
}

TEST(Localizer, KnowsHowSureItIs) {
  double nees = 0.0;
  constexpr int kRuns = 60;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    CircleWorld world(seed);
    Localizer filter(map_of(world), {}, {}, world.mount());
    drive(filter, world, 60);
    const auto pose = filter.pose();
    nees += *mahalanobis_squared<3>(difference(world.truth(), pose.T_world_robot), pose.covariance);
  }
  // 99.9 % band of a mean of 60 chi-square variables with 3 degrees of freedom.
  EXPECT_GT(nees / kRuns, 2.05);
  EXPECT_LT(nees / kRuns, 4.12);
}

TEST(Localizer, LeavesTheMapAlone) {
  CircleWorld world(4);
  const MapState map = map_of(world);
  Localizer filter(map, {}, {}, world.mount());
  drive(filter, world, 60);
  EXPECT_EQ(filter.save().landmarks, map.landmarks);
  EXPECT_EQ(filter.save().covariance.bottomRightCorner(16, 16), map.covariance.bottomRightCorner(16, 16));
}

TEST(Localizer, SaysThatTheMapIsOfAnotherPlace) {
  CircleWorld world(5);
  MapState map = map_of(world);
  RandomStream random(5, StreamPurpose::kWorld);
  for (double& coordinate : map.landmarks) coordinate = random.uniform(-20.0, 20.0);
  Localizer filter(map, {}, {}, world.mount());
  drive(filter, world, 19);
  EXPECT_FALSE(filter.refusal());
  drive(filter, world, 1);
  ASSERT_TRUE(filter.refusal());
  EXPECT_THAT(filter.refusal()->message, testing::HasSubstr("another place"));
}

TEST(Localizer, SaysThatTheMapHasNoneOfTheLandmarks) {
  CircleWorld world(6);
  MapState map = map_of(world);
  for (LandmarkId& id : map.ids) id.number += 100;
  Localizer filter(map, {}, {}, world.mount());
  drive(filter, world, 20);
  ASSERT_TRUE(filter.refusal());
  EXPECT_THAT(filter.refusal()->message,
              testing::HasSubstr("of 8 landmarks seen in 20 sightings the map has 0"));
}

TEST(Localizer, WaitsWhileThereIsOnlyOneLandmarkToSee) {
  CircleWorld world(7);
  Localizer filter(map_of(world), {}, {}, world.mount());
  for (int i = 0; i < 100; ++i) {
    filter.predict(world.move());
    const Observation seen = world.sight(2);
    filter.correct({&seen, 1});
  }
  EXPECT_FALSE(filter.knows_pose());
  EXPECT_FALSE(filter.refusal());
}

TEST(Localizer, RefusesToGuessWhereEveryEighthOfATurnLooksAlike) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    CircleWorld world(seed);
    MapState map = map_of(world);
    const ekf::UnnamedOptions unnamed{true, {}, world.sensor()};
    Localizer filter(map, {}, {}, world.mount(), 1, {}, unnamed);
    for (int i = 0; i < 3; ++i) {
      filter.predict(world.move());
      auto scan = world.look();
      for (Observation& seen : scan) seen.id.reset();
      filter.correct(scan);
    }
    EXPECT_FALSE(filter.knows_pose());
    ASSERT_TRUE(filter.refusal());
    EXPECT_THAT(filter.refusal()->message, testing::HasSubstr("several places"));
  }
}

}  // namespace
}  // namespace waymark
