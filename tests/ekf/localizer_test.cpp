#include "waymark/ekf/localizer.hpp"

#include <gmock/gmock.h>

#include "support/circle_world.hpp"
#include "waymark/core/gaussian.hpp"

namespace waymark {
namespace {

using test::CircleWorld;

MapState map_of(CircleWorld& world) {
  EkfSlam filter({.capacity = 20}, world.sensor());
  for (int i = 0; i < 100; ++i) {
    filter.predict(world.move());
    filter.correct(world.look());
  }
  return filter.save();
}

/// One landmark after the other, as a slow reader has it.
void drive_round(Filter& filter, CircleWorld& world, int steps) {
  for (int i = 0; i < steps; ++i) {
    filter.predict(world.move());
    const Observation seen = world.sight((3 * i) % 8);
    filter.correct({&seen, 1});
  }
}

TEST(Localizer, FindsItselfWithinTheFirstObservationsAndStaysThere) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CircleWorld world(seed);
    const auto localizer = *Localizer::make(map_of(world), {}, world.sensor());
    Localizer& filter = *localizer;
    drive_round(filter, world, 2);
    EXPECT_FALSE(filter.knows_pose());
    drive_round(filter, world, 18);
    ASSERT_TRUE(filter.knows_pose());
    drive_round(filter, world, 80);
    EXPECT_LT((filter.pose().T_world_robot.position() - world.truth().position()).norm(), 0.3);
    EXPECT_EQ(filter.losses(), 0);
  }
}

TEST(Localizer, FindsBackIntoTheMapWhenTheRobotWasCarried) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CircleWorld world(seed);
    const auto localizer = *Localizer::make(map_of(world), {}, world.sensor());
    Localizer& filter = *localizer;
    drive_round(filter, world, 40);
    ASSERT_TRUE(filter.knows_pose());
    for (int i = 0; i < 30; ++i) world.move();  // of which the filter hears nothing
    drive_round(filter, world, 60);
    EXPECT_TRUE(filter.knows_pose()) << seed;
    EXPECT_FALSE(filter.health().lost) << seed;
    EXPECT_GT(filter.health().recoveries, 0) << seed;
    EXPECT_LT((filter.pose().T_world_robot.position() - world.truth().position()).norm(), 0.3) << seed;
  }
}

TEST(Localizer, KnowsHowSureItIs) {
  const double nees = test::mean_pose_nees([](CircleWorld& world) {
    const auto localizer = *Localizer::make(map_of(world), {}, world.sensor());
    Localizer& filter = *localizer;
    drive_round(filter, world, 60);
    return filter.pose();
  });
  EXPECT_GT(nees, test::kMinMeanNees);
  EXPECT_LT(nees, test::kMaxMeanNees);
}

TEST(Localizer, LeavesTheMapAlone) {
  CircleWorld world(4);
  const MapState map = map_of(world);
  const auto localizer = *Localizer::make(map, {}, world.sensor());
  Localizer& filter = *localizer;
  drive_round(filter, world, 60);
  EXPECT_EQ(filter.save().landmarks, map.landmarks);
  EXPECT_EQ(filter.save().covariance.bottomRightCorner(16, 16), map.covariance.bottomRightCorner(16, 16));
}

MapState shuffled(MapState map, std::uint64_t seed) {
  RandomStream random(seed, StreamPurpose::kWorld);
  for (double& coordinate : map.landmarks) coordinate = random.uniform(-20.0, 20.0);
  return map;
}

TEST(Localizer, SaysThatTheMapIsOfAnotherPlace) {
  int early = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CircleWorld world(seed);
    const auto localizer = *Localizer::make(shuffled(map_of(world), seed), {}, world.sensor());
    Localizer& filter = *localizer;
    drive_round(filter, world, 11);
    early += filter.refusal().has_value();
    drive_round(filter, world, 9);
    ASSERT_FALSE(filter.knows_pose());
    ASSERT_TRUE(filter.refusal());
    EXPECT_THAT(filter.refusal()->message, testing::HasSubstr("another place"));
  }
  EXPECT_GT(early, 0);  // where not even chance has put two of eight as far apart as they are
}

TEST(Localizer, TellsAnotherPlaceByTwoLandmarksWhenItHasDrivenForLong) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CircleWorld world(seed);
    const auto localizer = *Localizer::make(shuffled(map_of(world), seed), {}, world.sensor());
    Localizer& filter = *localizer;
    for (int i = 0; i < 100 && !filter.refusal(); ++i) {
      Motion motion = world.move();
      motion.duration_s = 0.1;
      filter.predict(motion);
      const Observation seen = world.sight(i % 2);
      if (i % 5 == 0) filter.correct({&seen, 1});
    }
    ASSERT_TRUE(filter.refusal()) << "seed " << seed;
    EXPECT_THAT(filter.refusal()->message, testing::HasSubstr("no more than 0 are arranged as in the map"));
  }
}

TEST(Localizer, AMisreadNumberIsNoOtherPlace) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CircleWorld world(seed);
    const auto localizer = *Localizer::make(map_of(world), {}, world.sensor());
    Localizer& filter = *localizer;
    Observation misread = world.sight(1);
    misread.id->number = 5;
    filter.correct({&misread, 1});
    drive_round(filter, world, 20);
    EXPECT_TRUE(filter.knows_pose()) << "seed " << seed;
  }
}

TEST(Localizer, SaysThatTheMapHasNoneOfTheLandmarks) {
  CircleWorld world(6);
  MapState map = map_of(world);
  for (LandmarkId& id : map.ids) id.number += 100;
  const auto localizer = *Localizer::make(map, {}, world.sensor());
  Localizer& filter = *localizer;
  drive_round(filter, world, 20);
  ASSERT_TRUE(filter.refusal());
  EXPECT_THAT(filter.refusal()->message,
              testing::HasSubstr("of 8 landmarks seen in 20 observations and 0 s of driving the map has 0"));
}

TEST(Localizer, WaitsWhileThereIsOnlyOneLandmarkToSee) {
  CircleWorld world(7);
  const auto localizer = *Localizer::make(map_of(world), {}, world.sensor());
  Localizer& filter = *localizer;
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
    const auto localizer = *Localizer::make(map, {.unknown = UnknownAssociation{}}, world.sensor());
    Localizer& filter = *localizer;
    for (int i = 0; i < 3; ++i) {
      filter.predict(world.move());
      auto scan = world.look();
      for (Observation& seen : scan) seen.id.reset();
      filter.correct(scan);
    }
    EXPECT_FALSE(filter.knows_pose());
    ASSERT_TRUE(filter.refusal());
    EXPECT_THAT(filter.refusal()->message, testing::HasSubstr("localisation is ambiguous"));
  }
}

}  // namespace
}  // namespace waymark
