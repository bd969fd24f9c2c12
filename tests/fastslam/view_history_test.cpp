#include "waymark/fastslam/view_history.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/poses.hpp"

namespace waymark::fastslam {
namespace {

constexpr LandmarkSensor kViewer{
    .min_range_m = 0.5, .max_range_m = 10.0, .field_of_view_deg = 90.0, .detection_probability = 0.8};
constexpr double kMissed = 0.2;

/// After so many scans, with this step before each.
ViewHistory history_of(const LandmarkSensor& sensor, const Pose2& step, int scans) {
  ViewHistory history(sensor);
  for (int scan = 0; scan < scans; ++scan) {
    history.move(step);
    history.scan();
  }
  return history;
}

Eigen::Vector2d at(double range_m, double bearing_deg) {
  return range_m * Eigen::Vector2d(std::cos(to_radians(bearing_deg)), std::sin(to_radians(bearing_deg)));
}

TEST(ViewHistory, RemembersTheScansBeforeTheLast) {
  EXPECT_EQ(ViewHistory(kViewer).earlier(), 0U);
  EXPECT_EQ(history_of(kViewer, {}, 1).earlier(), 0U);
  EXPECT_EQ(history_of(kViewer, {}, 3).earlier(), 2U);
  const std::size_t most = history_of(kViewer, {}, 100).earlier();
  EXPECT_GT(most, 2U);
  EXPECT_EQ(history_of(kViewer, {}, 1000).earlier(), most);
}

TEST(ViewHistory, KnowsWhereTheRobotWasAtEach) {
  RandomStream random(1, StreamPurpose::kWorld);
  ViewHistory history(kViewer);
  Pose2 robot;
  std::vector<Pose2> scans;
  for (int scan = 0; scan < 30; ++scan) {
    for (int part = 0; part < 2; ++part) {
      const Pose2 step = test::random_pose(random, 1.0);
      robot = robot * step;
      history.move(step);
    }
    history.scan();
    scans.push_back(robot);
    ASSERT_LT(history.earlier(), scans.size());
    for (std::size_t age = 0; age <= history.earlier(); ++age) {
      const Pose2 expected = robot.inverse() * scans[scans.size() - 1 - age];
      EXPECT_TRUE(
          test::matrix_near(difference(history.T_now_at(age), expected), Eigen::Vector3d::Zero(), 1e-9));
    }
  }
  history.move({1.0, 0.0, 0.0});
  EXPECT_NEAR(history.T_now_at(0).x_m, -1.0, 1e-12);
}

TEST(ViewHistory, WhatAStandingSensorOverlookedItOverlookedEveryTime) {
  const ViewHistory history = history_of(kViewer, {}, 4);
  EXPECT_NEAR(history.likelihood_unseen(at(5.0, 0.0), {}), std::pow(kMissed, 3), 1e-12);
  for (const Eigen::Vector2d& outside : {at(0.4, 0.0), at(10.1, 0.0), at(5.0, 46.0), at(5.0, -46.0)})
    EXPECT_EQ(history.likelihood_unseen(outside, {}), 1.0);
  EXPECT_EQ(history_of(kViewer, {}, 1).likelihood_unseen(at(5.0, 0.0), {}), 1.0);
}

TEST(ViewHistory, OnlyWhatWasInViewByTheMarginCounts) {
  const ViewHistory history = history_of(kViewer, {}, 2);
  EXPECT_NEAR(history.likelihood_unseen(at(9.8, 0.0), {0.1, 0.0}), kMissed, 1e-12);
  EXPECT_EQ(history.likelihood_unseen(at(9.8, 0.0), {0.3, 0.0}), 1.0);
  EXPECT_EQ(history.likelihood_unseen(at(0.7, 0.0), {0.3, 0.0}), 1.0);
  EXPECT_NEAR(history.likelihood_unseen(at(5.0, 43.0), {0.0, to_radians(1.0)}), kMissed, 1e-12);
  EXPECT_EQ(history.likelihood_unseen(at(5.0, 43.0), {0.0, to_radians(3.0)}), 1.0);
}

TEST(ViewHistory, DrivingAheadLandmarksEnterByTheReach) {
  const ViewHistory history = history_of(kViewer, {0.5, 0.0, 0.0}, 5);
  EXPECT_EQ(history.likelihood_unseen(at(9.8, 0.0), {}), 1.0);
  EXPECT_NEAR(history.likelihood_unseen(at(9.3, 0.0), {}), kMissed, 1e-12);
  EXPECT_NEAR(history.likelihood_unseen(at(8.8, 0.0), {}), kMissed * kMissed, 1e-12);
  EXPECT_NEAR(history.likelihood_unseen(at(5.0, 0.0), {}), std::pow(kMissed, 4), 1e-12);
}

TEST(ViewHistory, TurningLeftLandmarksEnterByTheLeftEdge) {
  const ViewHistory history = history_of(kViewer, {0.0, 0.0, to_radians(10.0)}, 4);
  EXPECT_EQ(history.likelihood_unseen(at(5.0, 40.0), {}), 1.0);
  EXPECT_NEAR(history.likelihood_unseen(at(5.0, 30.0), {}), kMissed, 1e-12);
  EXPECT_NEAR(history.likelihood_unseen(at(5.0, -40.0), {}), std::pow(kMissed, 3), 1e-12);
}

TEST(ViewHistory, LooksFromTheSensorNotFromTheRobot) {
  LandmarkSensor sensor = kViewer;
  sensor.x_m = 2.0;  // swings to the left when the robot turns left, and so past what is near
  sensor.yaw_deg = 90.0;
  const Pose2 turn{0.0, 0.0, to_radians(10.0)};
  const ViewHistory history = history_of(sensor, turn, 2);
  const Pose2 T_robot_sensor = sensor.T_robot_sensor();
  RandomStream random(2, StreamPurpose::kWorld);
  for (int k = 0; k < 1000; ++k) {
    const Eigen::Vector2d p_sensor(random.uniform(-1.0, 11.0), random.uniform(-11.0, 11.0));
    const Eigen::Vector2d before = T_robot_sensor.inverse() * (turn * (T_robot_sensor * p_sensor));
    EXPECT_NEAR(history.likelihood_unseen(p_sensor, {}), is_in_view(sensor, before) ? kMissed : 1.0, 1e-12);
  }
}

TEST(ViewHistory, WithoutAChanceOfDetectionNothingIsKnown) {
  LandmarkSensor sensor = kViewer;
  sensor.detection_probability = 0.0;
  EXPECT_EQ(history_of(sensor, {}, 5).likelihood_unseen(at(5.0, 0.0), {}), 1.0);
}

}  // namespace
}  // namespace waymark::fastslam
