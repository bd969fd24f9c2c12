#include "waymark/fastslam/particle_matcher.hpp"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/circle_world.hpp"
#include "support/unknown_identity_observations.hpp"
#include "support/unknown_identity_suite.hpp"
#include "waymark/fastslam/fast_slam.hpp"

#include "known_map.hpp"

namespace waymark {
namespace {

using test::CircleWorld;
using test::drive;
using test::without_identity;

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
INSTANTIATE_TYPED_TEST_SUITE_P(FastSlam, UnknownIdentityFilter, Particles);
}  // namespace test

namespace {

TEST(FastSlamUnknownIdentity, WithoutAssociationNothingOfUnknownIdentityIsUsed) {
  CircleWorld world(1);
  FastSlam filter({}, world.sensor());
  const Correction& correction = filter.correct(without_identity(world.look()));
  EXPECT_EQ(correction.count(Outcome::kUnidentified), 8);
}

TEST(FastSlamUnknownIdentity, TwoObservationsOfOneLandmarkSplitTheParticles) {
  CircleWorld world(6);
  FastSlam filter = make_filter(world);
  drive(filter, world, 20);
  const std::size_t landmarks = filter.snapshot().landmarks.size();
  for (int i = 0; i < 20; ++i) {
    filter.predict(world.move());
    auto scan = without_identity(world.look());
    scan.push_back(scan.front());
    auto& z = std::get<RangeBearing>(scan.back().value);
    z.range_m += 0.05;
    filter.correct(scan);
  }
  EXPECT_GT(filter.splits(), 0);
  drive(filter, world, 20);
  EXPECT_EQ(filter.snapshot().landmarks.size(), landmarks);
}

TEST(FastSlamUnknownIdentity, SameSeedSameBitsOnAnyNumberOfThreads) {
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

TEST(FastSlamUnknownIdentity, ASteadyStateStepOnTwoThreadsAllocatesNothing) {
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
namespace fastslam {
namespace {

constexpr LandmarkSensor kAllRound{.max_range_m = 10.0};

/// Particles at the origin that know two landmarks, far from each other.
class ParticleMatcherTest : public testing::Test {
 protected:
  ParticleMatcherTest() {
    test::add_point(belief_, {4.0, 0.0});
    test::add_point(belief_, {0.0, 5.0});
  }

  void match(const std::vector<Observation>& observations, int room = 100) {
    observations_ = observations;
    belief_.landmarks.begin_scan();
    scan_.begin(observations_);
    for (Innovation& innovation : scan_.innovations) innovation.outcome = Outcome::kUnidentified;
    matcher_.match(scan_, gate_, room, belief_);
  }

  Belief belief_{{.particles = 40}, kAllRound, 1};
  SensorModel sensor_{kAllRound, 1.0};
  InnovationGate gate_{{}, sensor_};
  ScanUpdate update_{{}, belief_.blocks};
  Scan scan_;
  std::vector<Observation> observations_;
  ParticleMatcher matcher_{AssociationModel({}, kAllRound), sensor_, belief_.blocks};
};

TEST_F(ParticleMatcherTest, TheSetDecidesWhatIsClear) {
  match({test::range_bearing(5.0, 0.5 * kPi), test::range_bearing(4.0, 0.0), test::range_bearing(8.0, -1.0)});
  EXPECT_FALSE(matcher_.any_ambiguous());
  EXPECT_EQ(scan_.landmarks, (std::vector<int>{1, 0, Scan::kNone}));
  EXPECT_TRUE(scan_.is(0, Outcome::kMatched));
  EXPECT_TRUE(scan_.is(2, Outcome::kAdded));
}

TEST_F(ParticleMatcherTest, WhereThereIsNoRoomNothingIsNew) {
  match({test::range_bearing(8.0, -1.0), test::range_bearing(8.0, 1.0)}, 1);
  EXPECT_TRUE(scan_.is(0, Outcome::kAdded));
  EXPECT_TRUE(scan_.is(1, Outcome::kMapFull));
}

TEST_F(ParticleMatcherTest, RangesAloneStayUnidentified) {
  match({test::range_alone(4.0)});
  EXPECT_FALSE(matcher_.any_ambiguous());
  EXPECT_TRUE(scan_.is(0, Outcome::kUnidentified));
}

TEST_F(ParticleMatcherTest, ParticlesDecideOnTwoObservationsOfOneLandmark) {
  match({test::range_bearing(4.0, 0.0), test::range_bearing(4.02, 0.0)});
  ASSERT_TRUE(matcher_.any_ambiguous());
  EXPECT_TRUE(matcher_.match_ambiguous(scan_, gate_, 100, belief_).empty());
  update_.begin();
  matcher_.split(scan_, update_, belief_);
  EXPECT_GT(matcher_.splits(), 0);
  ASSERT_FALSE(update_.accepted().empty());
  for (int i = 0; i < belief_.particles.count(); ++i) {
    float taken = 0.0F;
    for (const Association::Choice& choice : matcher_.choices())
      if (choice.landmark == 0) taken += choice.column[i];
    EXPECT_EQ(taken, 1.0F);
  }
  EXPECT_EQ(scan_.count(Outcome::kMatched), 1);
}

TEST_F(ParticleMatcherTest, WhatOtherLandmarksClaimIsNotOffered) {
  match({test::range_bearing(4.0, 0.0)});
  ASSERT_EQ(scan_.landmarks[0], 0);
  observations_ = {test::range_bearing(4.0, 0.0)};
  scan_.begin(observations_);  // of the same scan
  scan_.innovations[0].outcome = Outcome::kUnidentified;
  matcher_.match(scan_, gate_, 100, belief_);
  EXPECT_TRUE(scan_.is(0, Outcome::kAdded));
}

}  // namespace
}  // namespace fastslam

}  // namespace waymark
