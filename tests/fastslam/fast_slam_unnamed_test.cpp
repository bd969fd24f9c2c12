// FastSLAM over sightings without identity.

#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/circle_world.hpp"
#include "support/unnamed_sightings.hpp"
#include "waymark/fastslam/fast_slam.hpp"

namespace waymark {
namespace {

using test::CircleWorld;
using test::drive;
using test::nearest_m;
using test::unnamed;

FastSlam make_filter(const CircleWorld& world, int particles = 100, int threads = 1) {
  FastSlamOptions options;
  options.particles = particles;
  return {options, {}, world.sensor(), 1, threads, {}, AssociationOptions{}};
}

TEST(FastSlamUnnamed, FindsEveryLandmarkOnceAmongClutter) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CircleWorld world(seed);
    FastSlam filter = make_filter(world);
    drive(filter, world, 300, seed);
    const Snapshot snapshot = filter.snapshot();
    EXPECT_EQ(snapshot.landmarks.size(), world.landmarks().size());
    for (const auto& p : world.landmarks()) EXPECT_LT(nearest_m(snapshot, p), 0.5);
    EXPECT_LT((filter.pose().T_world_robot.position() - world.truth().position()).norm(), 0.5);
  }
}

TEST(FastSlamUnnamed, WithoutAssociationNothingUnnamedIsUsed) {
  CircleWorld world(1);
  FastSlam filter({}, {}, world.sensor(), 1);
  const Correction& correction = filter.correct(unnamed(world.look()));
  EXPECT_EQ(correction.count(Outcome::kUnidentified), 8);
}

TEST(FastSlamUnnamed, ASingleSightingIsNotInTheMapYet) {
  CircleWorld world(2);
  FastSlam filter = make_filter(world);
  EXPECT_EQ(filter.correct(unnamed(world.look())).count(Outcome::kAdded), 8);
  EXPECT_TRUE(filter.snapshot().landmarks.empty());
  EXPECT_TRUE(filter.save().ids.empty());
  drive(filter, world, 3);
  EXPECT_EQ(filter.snapshot().landmarks.size(), 8U);
  EXPECT_EQ(filter.save().ids.size(), 8U);
}

TEST(FastSlamUnnamed, ALandmarkThatIsSeenNoMoreIsDeletedAndReported) {
  CircleWorld world(3);
  FastSlam filter = make_filter(world);
  drive(filter, world, 20);
  ASSERT_EQ(filter.snapshot().landmarks.size(), 8U);
  std::size_t removed = 0;
  for (int i = 0; i < 20; ++i) {
    filter.predict(world.move());
    auto scan = unnamed(world.look());
    scan.erase(scan.begin() + 2);
    removed += filter.correct(scan).removed.size();
  }
  EXPECT_EQ(removed, 1U);
  const Snapshot snapshot = filter.snapshot();
  EXPECT_EQ(snapshot.landmarks.size(), 7U);
  EXPECT_GT(nearest_m(snapshot, world.landmarks()[2]), 1.0);
}

TEST(FastSlamUnnamed, IdentitiesCountWhereThereAreAny) {
  CircleWorld world(4);
  FastSlam filter = make_filter(world);
  for (int i = 0; i < 30; ++i) {
    filter.predict(world.move());
    auto scan = world.look();
    for (std::size_t k = 4; k < scan.size(); ++k) scan[k].id.reset();
    filter.correct(scan);
  }
  const auto landmarks = filter.snapshot().landmarks;
  EXPECT_EQ(landmarks.size(), 8U);
  EXPECT_EQ(std::ranges::count(landmarks, LandmarkId::Family::kMarker,
                               [](const LandmarkEstimate& each) { return each.id.family; }),
            4);
}

TEST(FastSlamUnnamed, AnUnnamedSightingMayBeOfANamedLandmark) {
  CircleWorld world(5);
  FastSlam filter = make_filter(world);
  filter.correct(world.look());
  filter.predict(world.move());
  EXPECT_EQ(filter.correct(unnamed(world.look())).count(Outcome::kMatched), 8);
}

TEST(FastSlamUnnamed, TwoSightingsOfOneLandmarkSplitTheParticles) {
  CircleWorld world(6);
  FastSlam filter = make_filter(world);
  drive(filter, world, 20);
  const std::size_t landmarks = filter.snapshot().landmarks.size();
  for (int i = 0; i < 20; ++i) {
    filter.predict(world.move());
    auto scan = unnamed(world.look());
    scan.push_back(scan.front());
    auto& z = std::get<RangeBearing>(scan.back().value);
    z.range_m += 0.05;
    filter.correct(scan);
  }
  EXPECT_GT(filter.splits(), 0);
  drive(filter, world, 20);
  EXPECT_EQ(filter.snapshot().landmarks.size(), landmarks);
}

TEST(FastSlamUnnamed, SameSeedSameBitsOnAnyNumberOfThreads) {
  const auto run = [](int threads) {
    CircleWorld world(7);
    FastSlam filter = make_filter(world, 3000, threads);
    drive(filter, world, 30);
    const MapState map = filter.save();
    return std::pair(map.landmarks, filter.pose().T_world_robot);
  };
  const auto one = run(1);
  const auto three = run(3);
  EXPECT_EQ(one.second, three.second);
  EXPECT_EQ(one.first, three.first);
}

TEST(FastSlamUnnamed, ASteadyStateStepAllocatesNothing) {
  CircleWorld world(8);
  FastSlam filter = make_filter(world, 300, 2);
  drive(filter, world, 200);
  const test::Steps steps = test::cluttered_steps(world, 50, 3);
  int added = 0;
  const test::AllocationCount count;
  for (const auto& [motion, scan] : steps) {
    filter.predict(motion);
    added += filter.correct(scan).count(Outcome::kAdded);
  }
  EXPECT_EQ(count.allocations(), 0);
  EXPECT_GT(added, 0);
}

TEST(FastSlamUnnamed, AFullMapSaysSo) {
  CircleWorld world(9);
  FastSlamOptions options;
  options.capacity = 5;
  FastSlam filter(options, {}, world.sensor(), 1, 1, {}, AssociationOptions{});
  const Correction& correction = filter.correct(unnamed(world.look()));
  EXPECT_EQ(correction.count(Outcome::kAdded), 5);
  EXPECT_EQ(correction.count(Outcome::kMapFull), 3);
}

}  // namespace
}  // namespace waymark
