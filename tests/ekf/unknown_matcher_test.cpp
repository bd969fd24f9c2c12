#include "waymark/ekf/unknown_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/circle_world.hpp"
#include "support/unknown_identity_observations.hpp"
#include "support/unknown_identity_suite.hpp"
#include "waymark/ekf/ekf_slam.hpp"

namespace waymark {
namespace {

using test::CircleWorld;
using test::drive;
using test::without_identity;

EkfSlam make_filter(const CircleWorld& world, EkfOptions options = {.capacity = 40}, bool jointly = true) {
  options.unknown = UnknownAssociation{jointly, {}};
  return {options, world.sensor()};
}

template <bool jointly>
struct Ekf {
  static EkfSlam make(const CircleWorld& world) { return make_filter(world, {.capacity = 40}, jointly); }
  static EkfSlam make_small(const CircleWorld& world) { return make_filter(world, {.capacity = 5}, jointly); }
};

using EitherWay = testing::Types<Ekf<true>, Ekf<false>>;

}  // namespace

namespace test {
INSTANTIATE_TYPED_TEST_SUITE_P(EkfSlam, UnknownIdentityFilter, EitherWay);
}  // namespace test

namespace {

TEST(UnknownMatcher, WithoutAssociationNothingOfUnknownIdentityIsUsed) {
  CircleWorld world(1);
  EkfSlam filter({.capacity = 40}, world.sensor());
  EXPECT_EQ(filter.correct(without_identity(world.look())).count(Outcome::kUnidentified), 8);
}

TEST(UnknownMatcher, WithoutClutterItIsTheFilterThatKnows) {
  CircleWorld identified(2);
  CircleWorld unidentified(2);
  EkfSlam knows({.capacity = 40}, identified.sensor());
  EkfSlam guesses = make_filter(unidentified);
  for (int i = 0; i < 100; ++i) {
    knows.predict(identified.move());
    knows.correct(identified.look());
    guesses.predict(unidentified.move());
    guesses.correct(without_identity(unidentified.look()));
  }
  const Eigen::Vector3d apart = difference(knows.pose().T_world_robot, guesses.pose().T_world_robot);
  EXPECT_LT(apart.cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((knows.save().covariance - guesses.save().covariance).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(UnknownMatcher, ASingleObservationIsNotInTheSavedCovarianceYet) {
  CircleWorld world(2);
  EkfSlam filter = make_filter(world);
  filter.correct(without_identity(world.look()));
  EXPECT_EQ(filter.save().covariance.rows(), 3);
  drive(filter, world, 3);
  EXPECT_EQ(filter.save().covariance.rows(), 19);
}

TEST(UnknownMatcher, WhatIsSavedIsTheMapWithoutTentativeLandmarks) {
  CircleWorld world(6);
  EkfSlam filter = make_filter(world);
  drive(filter, world, 20);
  filter.predict(world.move());
  auto scan = without_identity(world.look());
  RandomStream random(5, StreamPurpose::kSimulation);
  while (filter.correct(scan).count(Outcome::kAdded) == 0) scan.insert(scan.begin(), test::clutter(random));
  const Snapshot snapshot = filter.snapshot();
  const MapState map = filter.save();
  ASSERT_EQ(map.ids.size(), snapshot.landmarks.size());
  for (std::size_t i = 0; i < map.ids.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(2 * i);
    EXPECT_EQ(map.ids[i], snapshot.landmarks[i].id);
    EXPECT_LT((map.landmarks.segment<2>(row) - snapshot.landmarks[i].position_m.head<2>()).norm(), 1e-12);
    EXPECT_LT((map.covariance.block<2, 2>(row + 3, row + 3) -
               snapshot.landmarks[i].covariance.topLeftCorner<2, 2>())
                  .norm(),
              1e-12);
  }
}

TEST(UnknownMatcher, ASecondObservationBesideALandmarkIsAmbiguous) {
  CircleWorld world(7);
  EkfSlam filter = make_filter(world);
  drive(filter, world, 20);
  filter.predict(world.move());
  auto scan = without_identity(world.look());
  scan.push_back(scan.front());
  std::get<RangeBearing>(scan.back().value).range_m += 0.1;
  const Correction& correction = filter.correct(scan);
  EXPECT_EQ(correction.count(Outcome::kMatched), 8);
  EXPECT_EQ(correction.count(Outcome::kAmbiguous), 1);
}

TEST(UnknownMatcher, ACompressedMapIsTheSame) {
  CircleWorld world(8);
  const auto filter = [&world](Compress compressed) {
    return make_filter(world,
                       {.consistency = ekf::Consistency::kFej, .capacity = 120, .compressed = compressed});
  };
  EkfSlam whole = filter(Compress::kNever);
  EkfSlam compressed = filter(Compress::kAlways);
  for (const auto& [motion, scan] : test::cluttered_steps(world, 200)) {
    for (EkfSlam* each : {&whole, &compressed}) {
      each->predict(motion);
      each->correct(scan);
    }
  }
  EXPECT_LT((whole.save().covariance - compressed.save().covariance).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(UnknownMatcher, AFullMapStillTakesWhatIsSeen) {
  CircleWorld world(9);
  EkfSlam filter = make_filter(world, {.capacity = 5});
  drive(filter, world, 50);
  EXPECT_LE(filter.snapshot().landmarks.size(), 5U);
  EXPECT_LT((filter.pose().T_world_robot.position() - world.truth().position()).norm(), 1.0);
}

TEST(UnknownMatcher, NonsenseIsRefused) {
  CircleWorld world(10);
  EkfSlam filter = make_filter(world);
  drive(filter, world, 20);
  auto scan = without_identity(world.look());
  std::get<RangeBearing>(scan[0].value).range_m = NAN;
  scan[1].covariance = Eigen::Matrix2d::Constant(NAN);
  scan[2].covariance = Eigen::Matrix2d::Constant(INFINITY);
  scan[3].value = Bearing{0.1};
  const Correction& correction = filter.correct(scan);
  EXPECT_EQ(correction.count(Outcome::kUnusable), 4);
  EXPECT_EQ(correction.count(Outcome::kMatched), 4);
}

}  // namespace
}  // namespace waymark
