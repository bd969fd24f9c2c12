#include "waymark/association/fault_isolation.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "waymark/core/gaussian.hpp"

namespace waymark {
namespace {

LandmarkId marker(int number) { return {LandmarkId::Family::kMarker, number}; }

Observation seen(int number, double range_m, double bearing_rad = 0.0) {
  return {marker(number), RangeBearing{range_m, bearing_rad},
          Eigen::Matrix2d(Eigen::Vector2d(1e-4, 1e-4).asDiagonal())};
}

/// A table of landmarks of the first scan, and the scans that follow it.
class FaultIsolationTest : public ::testing::Test {
 protected:
  void add(int number, int observations = 5) {
    if (table_.scan() == 0) table_.begin_scan();
    table_.append({.id = marker(number), .observations = observations});
  }

  /// One scan: each observation with what the gate said.
  void scan(const std::vector<std::pair<Observation, Outcome>>& told) {
    table_.begin_scan();
    observations_.clear();
    innovations_.clear();
    for (const auto& [observation, outcome] : told) {
      observations_.push_back(observation);
      innovations_.push_back({.landmark = *observation.id, .outcome = outcome, .dof = 2});
    }
    faults_.review(observations_, innovations_, table_);
  }
  void gated(int number, double range_m, double bearing_rad = 0.0) {
    scan({{seen(number, range_m, bearing_rad), Outcome::kGated}});
  }
  void accepted(int number) { scan({{seen(number, 2.0), Outcome::kMatched}}); }

  FaultIsolation faults_{LandmarkSensor{}};
  LandmarkTable table_{64};
  std::vector<Observation> observations_;
  std::vector<Innovation> innovations_;
};

TEST_F(FaultIsolationTest, TwoThatAgreeOutweighASingleFirstObservation) {
  add(1, 1);
  gated(1, 3.0);
  EXPECT_FALSE(faults_.is_landmark_wrong(0));
  gated(1, 3.001);
  EXPECT_TRUE(faults_.is_landmark_wrong(0));
  EXPECT_EQ(faults_.health().false_firsts, 1);
}

TEST_F(FaultIsolationTest, OutliersThatContradictEachOtherProveNothing) {
  add(1, 1);
  for (const double range_m : {3.0, 5.0, 1.0, 4.0}) {
    gated(1, range_m);
    EXPECT_FALSE(faults_.is_landmark_wrong(0)) << range_m;
  }
}

TEST_F(FaultIsolationTest, AgreementIsByOdometry) {
  add(1, 1);
  gated(1, 3.0);
  faults_.predict({{1.0, 0.0, 0.0}, Eigen::Matrix3d::Identity() * 1e-6, 0.1});
  gated(1, 3.0);  // was expected at 2 m
  EXPECT_FALSE(faults_.is_landmark_wrong(0));
  faults_.predict({{1.0, 0.0, 0.0}, Eigen::Matrix3d::Identity() * 1e-6, 0.1});
  gated(1, 2.0);
  EXPECT_TRUE(faults_.is_landmark_wrong(0));
}

TEST_F(FaultIsolationTest, FiveOfOneLandmarkAloneMayBeASlip) {
  add(1);
  const auto slips = [&](double expected_sigma_m) {
    observations_ = {seen(1, 3.0)};
    innovations_ = {{.landmark = marker(1), .outcome = Outcome::kGated, .dof = 2, .nis = 40.0}};
    innovations_[0].log_density =
        log_gaussian<2>(40.0, Eigen::Matrix2d(Eigen::Vector2d(1.0, 1.0 / 9.0).asDiagonal()) *
                                  (expected_sigma_m * expected_sigma_m));
    table_.begin_scan();
    faults_.review(observations_, innovations_, table_);
    return faults_.wants_relocation();
  };
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(slips(0.05));
  EXPECT_TRUE(slips(0.05));
  int inflations = 0;
  faults_.relocate([] { return MapState{}; }, {}, innovations_,
                   [&](const Motion& motion) {
                     EXPECT_EQ(motion.increment, Pose2{});
                     ++inflations;
                   });
  EXPECT_EQ(inflations, 4);
  EXPECT_FALSE(slips(0.05));
  accepted(1);
  // Where it is expected anywhere within half a metre, a slip explains nothing.
  for (int i = 0; i < 6; ++i) EXPECT_FALSE(slips(0.5));
}

TEST_F(FaultIsolationTest, WhatPassesAWideGateAfterManyThatDidNotIsGated) {
  add(1);
  const auto outcome = [&](double nis) {
    observations_ = {seen(1, 3.0)};
    innovations_ = {{.landmark = marker(1), .outcome = Outcome::kMatched, .dof = 2, .nis = nis}};
    faults_.review(observations_, innovations_, table_);
    return innovations_[0].outcome;
  };
  for (int i = 0; i < 4; ++i) gated(1, 3.0);
  EXPECT_EQ(outcome(20.0), Outcome::kMatched);
  for (int i = 0; i < 5; ++i) gated(1, 3.0);
  EXPECT_EQ(outcome(20.0), Outcome::kGated);
  EXPECT_EQ(outcome(9.0), Outcome::kMatched);  // chi-square: 99 % below 9.2
  EXPECT_EQ(outcome(20.0), Outcome::kMatched);
}

TEST_F(FaultIsolationTest, AnAcceptedObservationEndsAContradiction) {
  add(1, 1);
  gated(1, 3.0);
  accepted(1);
  gated(1, 3.0);
  EXPECT_FALSE(faults_.is_landmark_wrong(0));
}

/// Farther than the errors of observations last.
const Motion kOnTheSpot{{0.0, 0.0, 2.0 * kPi}, Eigen::Matrix3d::Identity() * 1e-9, 1.0};

TEST_F(FaultIsolationTest, OneLandmarkAgainstOthersWasCarried) {
  add(1);
  add(2);
  add(3);
  gated(1, 3.0);
  faults_.predict(kOnTheSpot);
  for (int i = 0; i < 3; ++i) accepted(2);
  accepted(3);
  gated(1, 3.0);
  EXPECT_FALSE(faults_.is_landmark_wrong(0));
  gated(1, 3.0);
  EXPECT_TRUE(faults_.is_landmark_wrong(0));
  EXPECT_FALSE(faults_.health().lost);
  EXPECT_EQ(faults_.health().carried, 1);
  EXPECT_FALSE(faults_.is_distrusted(marker(1)));
}

TEST_F(FaultIsolationTest, WhereManyWereCarriedItIsNotTheLandmarks) {
  for (int number = 1; number <= 4; ++number) add(number);
  const auto is_carried = [&](int number) {
    gated(number, 3.0);
    faults_.predict(kOnTheSpot);
    for (int i = 0; i < 3; ++i) accepted(3);
    accepted(4);
    gated(number, 3.0);
    gated(number, 3.0);
    return faults_.is_landmark_wrong(0);
  };
  EXPECT_TRUE(is_carried(1));
  EXPECT_FALSE(is_carried(2));
}

TEST_F(FaultIsolationTest, OneLandmarkAgainstOneOtherMayBeEither) {
  add(1);
  add(2);
  for (int i = 0; i < 9; ++i) {
    gated(1, 3.0);
    EXPECT_FALSE(faults_.is_landmark_wrong(0));
    accepted(2);
    faults_.predict(kOnTheSpot);
  }
}

TEST_F(FaultIsolationTest, MoreThatContradictThanSupportMeanThatTheRobotIsLost) {
  add(1);
  add(2);
  add(3);
  for (int i = 0; i < 4; ++i) {
    accepted(3);  // by which it closed a loop, and which had been carried
    scan({{seen(1, 3.0), Outcome::kGated}, {seen(2, 3.0, 1.0), Outcome::kGated}});
    EXPECT_FALSE(faults_.is_landmark_wrong(0));
    EXPECT_FALSE(faults_.is_landmark_wrong(1));
  }
  EXPECT_TRUE(faults_.health().lost);
}

TEST_F(FaultIsolationTest, OneLandmarkAloneIsNobodysFault) {
  add(1);
  for (int i = 0; i < 20; ++i) {
    gated(1, 3.0);
    EXPECT_FALSE(faults_.is_landmark_wrong(0));
    EXPECT_FALSE(faults_.health().lost);
  }
}

TEST_F(FaultIsolationTest, ALandmarkThatIsFoundElsewhereAgainIsDistrusted) {
  add(1);
  add(2);
  add(3);
  for (const double range_m : {3.0, 2.0}) {
    gated(1, range_m);
    faults_.predict(kOnTheSpot);
    for (int i = 0; i < 3; ++i) accepted(2);
    accepted(3);
    gated(1, range_m);
    gated(1, range_m);
    EXPECT_TRUE(faults_.is_landmark_wrong(0));
  }
  EXPECT_TRUE(faults_.is_distrusted(marker(1)));
  EXPECT_FALSE(faults_.is_distrusted(marker(2)));
  EXPECT_EQ(faults_.health().carried, 1);
  EXPECT_EQ(faults_.health().distrusted, 1);
}

TEST_F(FaultIsolationTest, WhatALostRobotAddedSupportsNothing) {
  add(1);
  table_.begin_scan();
  add(2);
  add(3);  // since then nothing of what was there before was observed
  gated(1, 3.0);
  faults_.predict(kOnTheSpot);
  for (int i = 0; i < 3; ++i) accepted(2);
  accepted(3);
  gated(1, 3.0);
  gated(1, 3.0);
  EXPECT_FALSE(faults_.is_landmark_wrong(0));
}

TEST_F(FaultIsolationTest, SeveralLandmarksAgainstTheRobotMeanThatItIsLost) {
  add(1);
  add(2);
  for (int i = 0; i < 3; ++i) gated(1, 3.0);
  EXPECT_FALSE(faults_.health().lost);
  gated(2, 3.0, 1.0);
  EXPECT_FALSE(faults_.health().lost);
  gated(2, 3.0, 1.0);
  EXPECT_TRUE(faults_.health().lost);
  EXPECT_TRUE(faults_.wants_relocation());
  EXPECT_FALSE(faults_.wants_relocation());
}

TEST_F(FaultIsolationTest, AnAcceptedObservationBetweenThemMeansThatItIsNot) {
  add(1);
  add(2);
  add(3);
  add(4);
  for (int i = 0; i < 3; ++i) {
    gated(1, 3.0);
    accepted(3);
    accepted(4);
  }
  for (int i = 0; i < 3; ++i) {
    gated(2, 3.0, 1.0);
    accepted(3);
    accepted(4);
  }
  EXPECT_FALSE(faults_.health().lost);
}

TEST_F(FaultIsolationTest, FindsTheMotionToWhereTheLandmarksAreArrangedAsInTheMap) {
  MapState map;
  map.ids = {marker(1), marker(2), marker(3)};
  map.observations = {9, 9, 9};
  map.landmarks.resize(6);
  map.landmarks << 2.0, 0.0, 3.0, 1.0, 1.0, 2.0;
  map.covariance = Eigen::MatrixXd::Identity(9, 9) * 1e-6;
  const Pose2 T_world_robot{0.5, -0.5, 1.0};  // where it really is
  for (int number = 1; number <= 3; ++number) add(number);
  for (int i = 0; i < 2; ++i)
    for (int number = 1; number <= 3; ++number) {
      const Eigen::Vector2d p =
          T_world_robot.inverse() * Eigen::Vector2d(map.landmarks.segment<2>(2 * number - 2));
      gated(number, p.norm(), std::atan2(p.y(), p.x()));
    }
  ASSERT_TRUE(faults_.health().lost);
  const Pose2 believed{3.0, 4.0, -2.0};
  const auto motion = faults_.find_motion(map, believed);
  ASSERT_TRUE(motion);
  const Pose2 found = believed * motion->increment;
  EXPECT_NEAR(found.x_m, T_world_robot.x_m, 1e-6);
  EXPECT_NEAR(found.y_m, T_world_robot.y_m, 1e-6);
  EXPECT_NEAR(found.theta_rad, T_world_robot.theta_rad, 1e-6);
  // Places that are unsure by 1 cm each give a pose of about a centimetre, told as three times that.
  EXPECT_GT(motion->covariance(0, 0), 1e-5);
  EXPECT_LT(motion->covariance(0, 0), 9e-3);

  MapState other = map;
  other.landmarks[0] = 9.0;
  other.landmarks[3] = 9.0;
  EXPECT_FALSE(faults_.find_motion(other, believed));

  int moved = 0;
  faults_.relocate([&] { return map; }, believed, innovations_, [&](const Motion&) { ++moved; });
  EXPECT_EQ(moved, 1);
  EXPECT_EQ(faults_.health().recoveries, 1);
  EXPECT_FALSE(faults_.health().lost);
  EXPECT_FALSE(faults_.health().lost);
}

}  // namespace
}  // namespace waymark
