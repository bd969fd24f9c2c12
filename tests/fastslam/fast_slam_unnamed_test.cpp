// FastSLAM over sightings without identity.

#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/circle_world.hpp"
#include "support/unnamed_filter_suite.hpp"
#include "support/unnamed_sightings.hpp"
#include "waymark/fastslam/fast_slam.hpp"

namespace waymark {
namespace {

using test::CircleWorld;
using test::drive;
using test::unnamed;

FastSlam make_filter(const CircleWorld& world, int particles = 100, int threads = 1) {
  FastSlamOptions options;
  options.particles = particles;
  options.unknown.emplace();
  return {options, world.sensor(), threads};
}

struct Particles {
  static FastSlam make(const CircleWorld& world) { return make_filter(world); }
  static FastSlam make_small(const CircleWorld& world) {
    FastSlamOptions options;
    options.capacity = 5;
    options.unknown.emplace();
    return {options, world.sensor()};
  }
};

}  // namespace

namespace test {
INSTANTIATE_TYPED_TEST_SUITE_P(FastSlam, UnnamedFilter, Particles);
}  // namespace test

namespace {

TEST(FastSlamUnnamed, WithoutAssociationNothingUnnamedIsUsed) {
  CircleWorld world(1);
  FastSlam filter({}, world.sensor());
  const Correction& correction = filter.correct(unnamed(world.look()));
  EXPECT_EQ(correction.count(Outcome::kUnidentified), 8);
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

TEST(FastSlamUnnamed, ASteadyStateStepOnTwoThreadsAllocatesNothing) {
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

}  // namespace
}  // namespace waymark
