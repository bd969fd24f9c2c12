#include "workbench/live/pose_of_now.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/stamps.hpp"

namespace waymark::live {
namespace {

using test::at;

/// On a circle of 1 m radius at 0.5 m/s, from the origin.
Pose2 truth(double t_s) {
  const double angle = 0.5 * t_s;
  return {std::sin(angle), 1.0 - std::cos(angle), wrap_angle(angle)};
}

Event odometry(double t_s) { return {at(t_s), OdometryPose{truth(t_s)}}; }

void expect_near(const Pose2& a, const Pose2& b, double tolerance) {
  EXPECT_LT(difference(a, b).norm(), tolerance) << a.x_m << " " << a.y_m << " / " << b.x_m << " " << b.y_m;
}

TEST(PoseOfNow, KnowsNothingBeforeTheFilterDoes) {
  PoseOfNow pose({}, 2.0);
  EXPECT_FALSE(pose.add(odometry(0.0)));
  EXPECT_FALSE(pose.now());
}

TEST(PoseOfNow, IsThePoseOfTheFilterAndTheMotionSince) {
  PoseOfNow pose({}, 2.0);
  for (int i = 0; i <= 30; ++i) static_cast<void>(pose.add(odometry(i / 30.0)));
  const Pose2 T_world_odom{5.0, -2.0, 0.7};
  pose.correct({at(0.5), {T_world_odom * truth(0.5), 1e-4 * Eigen::Matrix3d::Identity()}});
  ASSERT_TRUE(pose.now());
  EXPECT_EQ(pose.now()->stamp, at(1.0));
  expect_near(pose.now()->estimate.T_world_robot, T_world_odom * truth(1.0), 1e-9);
  const auto next = pose.add(odometry(31.0 / 30.0));
  ASSERT_TRUE(next);
  expect_near(next->estimate.T_world_robot, T_world_odom * truth(31.0 / 30.0), 1e-9);
  EXPECT_GT(next->estimate.covariance.trace(), 3e-4);
}

TEST(PoseOfNow, CountsThePartOfAStepAfterTheFilter) {
  PoseOfNow pose({}, 2.0);
  for (int i = 0; i <= 10; ++i) static_cast<void>(pose.add(odometry(0.1 * i)));
  pose.correct({at(0.55), {truth(0.55), Eigen::Matrix3d::Zero()}});
  expect_near(pose.now()->estimate.T_world_robot, truth(1.0), 1e-3);  // a chord of 5 cm for an arc
}

TEST(PoseOfNow, MayBeCorrectedAgainAndLater) {
  PoseOfNow pose({}, 2.0);
  for (int i = 0; i <= 10; ++i) static_cast<void>(pose.add(odometry(0.1 * i)));
  pose.correct({at(0.3), {truth(0.3), Eigen::Matrix3d::Zero()}});
  const Pose2 moved = Pose2{1.0, 0.0, 0.0} * truth(0.8);
  pose.correct({at(0.8), {moved, Eigen::Matrix3d::Zero()}});
  expect_near(pose.now()->estimate.T_world_robot, Pose2{1.0, 0.0, 0.0} * truth(1.0), 1e-9);
  pose.correct({at(1.2), {truth(1.2), Eigen::Matrix3d::Zero()}});
  EXPECT_EQ(pose.now()->stamp, at(1.2));
}

TEST(PoseOfNow, FollowsOneOdometry) {
  PoseOfNow pose({}, 2.0);
  static_cast<void>(pose.add(odometry(0.0)));
  pose.correct({at(0.0), {}});
  EXPECT_FALSE(pose.add({at(0.05), {0, 3}, OdometryPose{{100.0, 0.0, 0.0}}}));
  EXPECT_FALSE(pose.add({at(0.05), {0, 3}, Observations{}}));
  const auto next = pose.add(odometry(0.1));
  ASSERT_TRUE(next);
  expect_near(next->estimate.T_world_robot, truth(0.1), 1e-9);
}

TEST(PoseOfNow, LeavesOutWhatIsOlderThanWhatItHas) {
  PoseOfNow pose({}, 2.0);
  for (int i = 0; i <= 3; ++i) static_cast<void>(pose.add(odometry(0.1 * i)));
  pose.correct({at(0.3), {truth(0.3), Eigen::Matrix3d::Zero()}});
  EXPECT_FALSE(pose.add(odometry(0.2)));
  EXPECT_EQ(pose.now()->stamp, at(0.3));
}

}  // namespace
}  // namespace waymark::live
