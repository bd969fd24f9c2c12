#include "waymark/ekf/deferred_initialiser.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/circle_world.hpp"
#include "waymark/core/gaussian.hpp"
#include "waymark/ekf/ekf_slam.hpp"

namespace waymark {
namespace {

using test::CircleWorld;

enum class Part { kRange, kBearing };

std::vector<Observation> part_of(std::vector<Observation> scan, Part part) {
  for (Observation& seen : scan) {
    const auto z = std::get<RangeBearing>(seen.value);
    const Eigen::Matrix2d R = *seen.covariance;
    const bool range = part == Part::kRange;
    if (range)
      seen.value = Range{z.range_m};
    else
      seen.value = Bearing{z.bearing_rad};
    seen.covariance = Eigen::Vector2d(range ? R(0, 0) : R(1, 1), 0.0).asDiagonal().toDenseMatrix();
  }
  return scan;
}

void drive(EkfSlam& filter, CircleWorld& world, int steps, Part part) {
  for (int i = 0; i < steps; ++i) {
    filter.predict(world.move());
    filter.correct(part_of(world.look(), part));
  }
}

/// A robot that drives a bend past one landmark, which only a DeferredInitialiser hears of.
class OneLandmark : public testing::TestWithParam<Part> {
 protected:
  /// Drives on, and tells of the landmark without error.
  [[nodiscard]] Outcome step() {
    const Motion motion{{0.25, 0.0, 0.1}, 1e-6 * Eigen::Matrix3d::Identity()};
    map_.state().predict(motion);
    map_.table().travel(travelled_m(motion));
    map_.table().begin_scan();
    initialiser_.begin_scan();
    return observe();
  }
  [[nodiscard]] Outcome observe() {
    const Eigen::Vector2d p = map_.state().active().pose().T_world_robot.inverse() * kPlace;
    Observation observation{kId, Range{p.norm()}, Eigen::Matrix2d(1e-4 * Eigen::Matrix2d::Identity())};
    if (GetParam() == Part::kBearing) observation.value = Bearing{std::atan2(p.y(), p.x())};
    return initialiser_.observe(kId, observation);
  }

  static constexpr LandmarkId kId{LandmarkId::Family::kMarker, 3};
  const Eigen::Vector2d kPlace{2.0, 3.0};
  ekf::SensorBiasStates errors_{SensorErrors{}};
  ekf::PointMap map_{{.capacity = 40}, errors_.pairs(), 1};
  ekf::PointObservation observation_{map_.state(), errors_, Pose2{}};
  ekf::DeferredInitialiser initialiser_{map_, observation_, ekf::Consistency::kInvariant};
};

TEST_P(OneLandmark, IsInitialisedWhereItIsOnceItsViewsTell) {
  int steps = 1;
  while (step() == Outcome::kDeferred) {
    EXPECT_FALSE(map_.table().find(kId));
    ASSERT_LT(++steps, 60);
  }
  EXPECT_GE(steps, 4);
  ASSERT_EQ(map_.table().find(kId), 0) << "no viewpoint is left";
  EXPECT_EQ(map_.table().size(), 1);
  EXPECT_TRUE(map_.table().is_in_map(0));
  EXPECT_LT((map_.state().landmark(0).head<2>() - kPlace).norm(), 0.05);
}

TEST_P(OneLandmark, OfAStandingRobotOneViewIsKept) {
  for (int i = 0; i < 10; ++i) EXPECT_EQ(observe(), Outcome::kDeferred);
  EXPECT_EQ(map_.table().size(), GetParam() == Part::kBearing ? 2 : 1);
  EXPECT_FALSE(map_.table().is_in_map(0));
}

TEST_P(OneLandmark, ViewpointsStayTheSameWhenLandmarksAreRemoved) {
  map_.append({5.0, 5.0}, 1e-4 * Eigen::Matrix2d::Identity(), {}, {.id = {LandmarkId::Family::kMarker, 99}});
  for (int i = 0; i < 3; ++i) EXPECT_EQ(step(), Outcome::kDeferred);
  map_.remove(0);
  int steps = 0;
  while (step() == Outcome::kDeferred) ASSERT_LT(++steps, 60);
  EXPECT_LT((map_.state().landmark(0).head<2>() - kPlace).norm(), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Each, OneLandmark, testing::Values(Part::kRange, Part::kBearing));

class DeferredInitialisation : public testing::TestWithParam<Part> {};

TEST_P(DeferredInitialisation, FollowsTheTruthWithinItsOwnUncertainty) {
  double nees = 0.0;
  double landmark_nees = 0.0;
  constexpr int kRuns = 16;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    CircleWorld world(seed);
    EkfSlam filter({ekf::Consistency::kInvariant, 100}, world.sensor());
    drive(filter, world, 200, GetParam());
    const auto pose = filter.pose();
    nees += *mahalanobis_squared<3>(difference(world.truth(), pose.T_world_robot), pose.covariance) / kRuns;
    const auto landmarks = filter.snapshot().landmarks;
    ASSERT_EQ(landmarks.size(), 8U) << seed;
    for (const auto& landmark : landmarks) {
      const Eigen::Vector2d error =
          landmark.position_m.head<2>() - world.landmarks()[static_cast<std::size_t>(landmark.id.number)];
      landmark_nees +=
          *mahalanobis_squared<2>(error, landmark.covariance.topLeftCorner<2, 2>()) / (8 * kRuns);
    }
  }
  // 99.9 % band of a mean of 16 chi-square variables with 3 degrees of freedom; landmarks of one run share
  // their errors, so theirs is as wide.
  EXPECT_GT(nees, 1.3);
  EXPECT_LT(nees, 5.2);
  EXPECT_GT(landmark_nees, 0.7);
  EXPECT_LT(landmark_nees, 4.0);
}

INSTANTIATE_TEST_SUITE_P(Each, DeferredInitialisation, testing::Values(Part::kRange, Part::kBearing));

class DeferredInitialisations : public testing::TestWithParam<std::tuple<Part, ekf::Consistency>> {
 protected:
  static EkfSlam make(const CircleWorld& world, int capacity = 100) {
    return EkfSlam({std::get<1>(GetParam()), capacity}, world.sensor());
  }
  static Part part() { return std::get<0>(GetParam()); }
};

TEST_P(DeferredInitialisations, NoViewpointIsLeftOnceAllLandmarksAreLocated) {
  CircleWorld world(3);
  EkfSlam filter = make(world);
  drive(filter, world, 5, part());
  EXPECT_GT(filter.state().landmarks(), 0);
  EXPECT_TRUE(filter.snapshot().landmarks.empty());
  EXPECT_TRUE(filter.save().ids.empty());
  drive(filter, world, 195, part());
  EXPECT_EQ(filter.snapshot().landmarks.size(), 8U);
  EXPECT_EQ(filter.state().landmarks(), 8);
}

TEST_P(DeferredInitialisations, ALandmarkIsPendingUntilItIsAddedOnce) {
  CircleWorld world(4);
  EkfSlam filter = make(world);
  EXPECT_EQ(filter.correct(part_of(world.look(), part())).count(Outcome::kDeferred), 8);
  int added = 0;
  for (int i = 0; i < 200; ++i) {
    filter.predict(world.move());
    added += filter.correct(part_of(world.look(), part())).count(Outcome::kAdded);
  }
  EXPECT_EQ(added, 8);
  EXPECT_EQ(filter.correct(part_of(world.look(), part())).count(Outcome::kMatched), 8);
}

TEST_P(DeferredInitialisations, ARobotThatStandsNeverLocates) {
  CircleWorld world(5);
  EkfSlam filter = make(world);
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(filter.correct(part_of(world.look(), part())).count(Outcome::kDeferred), 8);
  EXPECT_LE(filter.state().landmarks(), 2);
}

TEST_P(DeferredInitialisations, AMapWithLittleRoomStaysWithinIt) {
  CircleWorld world(6);
  EkfSlam filter = make(world, 12);
  for (int i = 0; i < 200; ++i) {
    filter.predict(world.move());
    filter.correct(part_of(world.look(), part()));
    ASSERT_LE(filter.state().landmarks(), 12);
    ASSERT_TRUE(filter.pose().covariance.allFinite());
  }
}

INSTANTIATE_TEST_SUITE_P(All, DeferredInitialisations,
                         testing::Combine(testing::Values(Part::kRange, Part::kBearing),
                                          testing::Values(ekf::Consistency::kInvariant,
                                                          ekf::Consistency::kFej,
                                                          ekf::Consistency::kStandard)));

}  // namespace
}  // namespace waymark
