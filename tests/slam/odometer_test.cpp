#include "waymark/slam/odometer.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/poses.hpp"
#include "support/stamps.hpp"

namespace waymark {
namespace {

using test::at;

OdometryOptions wheels() {
  OdometryOptions options;
  options.wheels = {0.1, 0.1, 0.5};
  return options;
}

Pose2 sum(const std::vector<Motion>& motions) {
  Pose2 pose;
  for (const auto& motion : motions) pose = pose * motion.increment;
  return pose;
}

TEST(Odometer, StandsStillBeforeTheFirstReading) {
  Odometer odometer(wheels(), 1.0);
  EXPECT_TRUE(is_still(odometer.advance(at(3.0), nullptr)));
}

TEST(Odometer, HoldsTheLastVelocity) {
  Odometer odometer({}, 10.0);
  (void)odometer.advance(at(1.0), nullptr);
  odometer.add({at(1.0), Velocity{0.5, 0.0}});
  EXPECT_NEAR(odometer.advance(at(3.0), nullptr).increment.x_m, 1.0, 1e-12);
}

TEST(Odometer, AddsTheTurningThatIsMissingWhileItMoves) {
  OdometryOptions options;
  options.turn_bias_degps = 2.0;
  Odometer odometer(options, 10.0);
  (void)odometer.advance(at(1.0), nullptr);
  odometer.add({at(1.0), Velocity{0.5, to_radians(1.0)}});
  const Motion motion = odometer.advance(at(3.0), nullptr);
  EXPECT_NEAR(motion.increment.theta_rad, to_radians(6.0), 1e-12);
  EXPECT_EQ(motion.duration_s, 2.0);
  odometer.add({at(3.0), Velocity{0.0, 0.0}});
  EXPECT_TRUE(is_still(odometer.advance(at(5.0), nullptr)));
}

TEST(Odometer, HoldsTheLastSpeedAndSteeringAngle) {
  OdometryOptions options;
  options.car = {2.0, 0.5};
  Odometer odometer(options, 10.0);
  (void)odometer.advance(at(1.0), nullptr);
  EXPECT_TRUE(odometer.add({at(1.0), Steering{0.5, 0.3}}));
  const std::vector<Motion> motions{odometer.advance(at(1.5), nullptr), odometer.advance(at(3.0), nullptr)};
  const Pose2 whole = steering_motion({0.5, 0.3}, 2.0, options).increment;
  EXPECT_TRUE(test::matrix_near(test::to_vector(sum(motions)), test::to_vector(whole), 1e-12));
}

TEST(Odometer, NoLongerHoldsASpeedInAGapAndIsNotSure) {
  Odometer odometer({}, 2.0);
  (void)odometer.advance(at(0.0), nullptr);
  odometer.add({at(0.0), Velocity{1.0, 0.0}});
  const std::vector<Motion> motions{odometer.advance(at(1.5), nullptr), odometer.advance(at(4.0), nullptr),
                                    odometer.advance(at(9.0), nullptr)};
  EXPECT_NEAR(sum(motions).x_m, 2.0, 1e-12);
  EXPECT_EQ(motions[2].increment, Pose2{});
  EXPECT_EQ(motions[2].duration_s, 5.0);
  EXPECT_NEAR(motions[2].covariance(0, 0), 1.0 * 2.0 * 5.0, 1e-12);  // 1 m/s, another every 2 s
  const std::vector<OdometryGap> gaps{{at(0.0), at(9.0), true}};
  EXPECT_EQ(odometer.gaps().all(), gaps);
}

/// The sum of variances along x over ten seconds without a reading, cut into `steps`.
double variance_of_gap_m2(int steps, bool next_is_known) {
  Odometer odometer({}, 2.0);
  (void)odometer.advance(at(0.0), nullptr);
  odometer.add({at(0.0), OdometryPose{}});
  const Event next{at(10.0), OdometryPose{}};
  double sum_m2 = 0.0;
  for (int i = 1; i <= steps; ++i)
    sum_m2 += odometer.advance(at(10.0 * i / steps), next_is_known ? &next : nullptr).covariance(0, 0);
  return sum_m2;
}

TEST(Odometer, IsAsUnsureOfAGapHoweverItIsCut) {
  EXPECT_GT(variance_of_gap_m2(1, false), 0.0);
  EXPECT_NEAR(variance_of_gap_m2(1, false), variance_of_gap_m2(7, false), 1e-12);
  EXPECT_NEAR(variance_of_gap_m2(2, true), variance_of_gap_m2(7, true), 1e-12);
}

TEST(Odometer, AGapBetweenTwoPosesIsMeasuredAsAWhole) {
  EXPECT_EQ(variance_of_gap_m2(1, true), 0.0);
  EXPECT_GT(variance_of_gap_m2(2, true), 0.0);
}

TEST(Odometer, InterpolatesWheelAnglesUpToTheNextReading) {
  Odometer odometer(wheels(), 1.0);
  (void)odometer.advance(at(0.0), nullptr);
  odometer.add({at(0.0), WheelAngles{5.0, 5.0}});
  const Event next{at(1.0), WheelAngles{6.0, 6.0}};
  EXPECT_NEAR(odometer.advance(at(0.25), &next).increment.x_m, 0.025, 1e-12);
  EXPECT_NEAR(odometer.advance(at(1.0), &next).increment.x_m, 0.075, 1e-12);
}

TEST(Odometer, TheWholeWayIsTheSameWhereverItIsCut) {
  const Event start{at(0.0), WheelAngles{0.0, 0.0}};
  const Event end{at(2.0), WheelAngles{3.0, 5.0}};
  std::vector<Pose2> poses;
  for (const int cuts : {1, 7}) {
    Odometer odometer(wheels(), 1.0);
    (void)odometer.advance(at(0.0), nullptr);
    odometer.add(start);
    std::vector<Motion> motions;
    for (int i = 1; i <= cuts; ++i) motions.push_back(odometer.advance(at(2.0 * i / cuts), &end));
    poses.push_back(sum(motions));
  }
  EXPECT_TRUE(test::matrix_near(test::to_vector(poses[0]), test::to_vector(poses[1]), 1e-12));
}

TEST(Odometer, ExtrapolatesWheelsAndCorrectsItselfWhenTheReadingComes) {
  Odometer odometer(wheels(), 1.0);
  std::vector<Motion> motions{odometer.advance(at(0.0), nullptr)};
  odometer.add({at(0.0), WheelAngles{0.0, 0.0}});
  motions.push_back(odometer.advance(at(1.0), nullptr));
  odometer.add({at(1.0), WheelAngles{2.0, 2.0}});
  motions.push_back(odometer.advance(at(1.5), nullptr));
  EXPECT_NEAR(sum(motions).x_m, 0.3, 1e-12);
  const Event late{at(2.0), WheelAngles{2.0, 2.0}};  // it had stopped
  motions.push_back(odometer.advance(at(2.0), &late));
  EXPECT_NEAR(sum(motions).x_m, 0.2, 1e-12);
}

TEST(Odometer, FollowsDeadReckonedPosesFromWhereverTheyStart) {
  Odometer odometer({}, 1.0);
  const Pose2 T_odom_start{3.0, -2.0, 1.0};
  const Pose2 step{0.5, 0.1, 0.2};
  (void)odometer.advance(at(0.0), nullptr);
  odometer.add({at(0.0), OdometryPose{T_odom_start}});
  const Event next{at(1.0), OdometryPose{T_odom_start * step}};
  EXPECT_TRUE(test::matrix_near(test::to_vector(odometer.advance(at(1.0), &next).increment),
                                test::to_vector(step), 1e-12));
}

/// The heading that is left when odometry that turns by 0.01 rad/s too much has reported these motions, each
/// for ten seconds; between two readings something is seen.
double heading_with_bias_rad(const std::vector<Velocity>& motions) {
  OdometryOptions options;
  options.standing = {0.05, 0.02};
  Odometer odometer(options, 1.0);
  (void)odometer.advance(at(0.0), nullptr);
  odometer.add({at(0.0), OdometryPose{}});
  Pose2 T_odom_robot, pose;
  for (std::size_t i = 0; i < motions.size(); ++i)
    for (int step = 1; step <= 100; ++step) {
      const double stamp_s = 10.0 * static_cast<double>(i) + 0.1 * step;
      const Pose2 moved = velocity_motion({motions[i].v_mps, motions[i].w_radps + 0.01}, 0.1, {}).increment;
      T_odom_robot = T_odom_robot * moved;
      const Event next{at(stamp_s), OdometryPose{T_odom_robot}};
      pose = pose * odometer.advance(at(stamp_s - 0.04), &next).increment;
      pose = pose * odometer.advance(at(stamp_s), &next).increment;
      odometer.add(next);
    }
  return pose.theta_rad;
}

TEST(Odometer, LearnsItsTurnBiasWhileTheRobotStandsAndTakesItOut) {
  EXPECT_NEAR(heading_with_bias_rad({{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.1}, {-0.5, 0.0}}), 1.0, 1e-9);
}

TEST(Odometer, KnowsNoTurnBiasBeforeTheRobotHasStood) {
  EXPECT_NEAR(heading_with_bias_rad({{1.0, 0.0}}), 0.1, 1e-9);
  EXPECT_NEAR(heading_with_bias_rad({{1.0, 0.0}, {0.0, 0.0}, {1.0, 0.0}}), 0.1, 1e-9);
}

TEST(Odometer, ATurnOnTheSpotIsNoBias) {
  EXPECT_NEAR(heading_with_bias_rad({{0.0, 0.05}, {1.0, 0.0}}), 0.7, 1e-9);
}

TEST(Odometer, RefusesASecondKind) {
  Odometer odometer({}, 1.0);
  (void)odometer.advance(at(0.0), nullptr);
  EXPECT_TRUE(odometer.add({at(0.0), Velocity{1.0, 0.0}}));
  EXPECT_FALSE(odometer.add({at(0.0), OdometryPose{}}));
}

TEST(Odometer, RefusesASecondDevice) {
  Odometer odometer({}, 1.0);
  (void)odometer.advance(at(0.0), nullptr);
  EXPECT_TRUE(odometer.add({at(0.0), StreamId{0, 1}, Velocity{1.0, 0.0}}));
  EXPECT_FALSE(odometer.add({at(0.0), StreamId{0, 2}, Velocity{9.0, 0.0}}));
  EXPECT_NEAR(odometer.advance(at(1.0), nullptr).increment.x_m, 1.0, 1e-12);
}

TEST(Odometer, TakesItsHeadingFromAGyro) {
  Odometer odometer({}, 1.0);
  (void)odometer.advance(at(0.0), nullptr);
  Pose2 pose;
  for (int i = 0; i < 200; ++i) {
    odometer.add({at(0.02 * i), Velocity{0.5, 0.5}});
    odometer.add({at(0.02 * i), YawRate{0.45}});
    const Event next{at(0.02 * (i + 1)), Velocity{0.5, 0.5}};
    const Event next_rate{next.stamp, YawRate{0.45}};
    pose = pose * odometer.advance(next.stamp, &next, &next_rate).increment;
  }
  EXPECT_NEAR(pose.theta_rad, 4.0 * 0.45, 0.06) << "and 0.05 rad/s until it is believed";
  EXPECT_TRUE(odometer.gyro().is_believed);
}

TEST(Odometer, TurnsAsItsOdometryWhereTheGyroIsSilent) {
  Odometer odometer({}, 2.0);
  (void)odometer.advance(at(0.0), nullptr);
  odometer.add({at(0.0), YawRate{0.0}});
  (void)odometer.advance(at(3.0), nullptr);
  odometer.add({at(3.0), Velocity{1.0, 0.5}});
  EXPECT_NEAR(odometer.advance(at(4.0), nullptr).increment.theta_rad, 0.5, 1e-12);
}

TEST(Odometer, AGyroAloneIsNoOdometry) {
  Odometer odometer({}, 1.0);
  (void)odometer.advance(at(0.0), nullptr);
  odometer.add({at(0.0), YawRate{1.0}});
  EXPECT_TRUE(is_still(odometer.advance(at(1.0), nullptr)));
  EXPECT_EQ(odometer.kind(), std::nullopt);
}

}  // namespace
}  // namespace waymark
