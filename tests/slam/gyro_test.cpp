#include "waymark/slam/gyro.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/stamps.hpp"
#include "waymark/core/angle.hpp"
#include "waymark/core/random.hpp"

namespace waymark {
namespace {

using test::at;

constexpr double kGyroStep_s = 0.02;
constexpr double kV_mps = 0.4;

/// Odometry and a gyro beside each other: rates of both over a time, in rad/s.
struct Turning {
  double for_s;
  double odometry_radps;
  double gyro_radps;
  double v_mps = kV_mps;
};

/// A robot whose gyro reads every 0.02 s, with white noise.
class GyroRobot {
 public:
  explicit GyroRobot(double noise_radps = 1e-4, std::uint64_t seed = 1)
      : noise_radps_(noise_radps), random_(seed, StreamPurpose::kSimulation) {}

  void drive(const Turning& turning, bool is_measured = true) {
    for (double t_s = 0.0; t_s < turning.for_s - 1e-9; t_s += kGyroStep_s) {
      gyro.add(at(kGyroStep_s * steps_), {turning.gyro_radps + noise_radps_ * random_.normal()});
      const Motion told = velocity_motion({turning.v_mps, turning.odometry_radps}, kGyroStep_s, {});
      ++steps_;
      last = gyro.hold_heading(told, {at(kGyroStep_s * (steps_ - 1)), at(kGyroStep_s * steps_), is_measured},
                               nullptr);
      theta_rad += last.increment.theta_rad;
      variance_rad2 += last.covariance(2, 2);
      odometry_variance_rad2 += told.covariance(2, 2);
    }
  }
  /// It repeats a reading exactly.
  void make_stuck() { noise_radps_ = 0.0; }
  void stand(double for_s, double bias_radps = 0.0) { drive({for_s, 0.0, bias_radps, 0.0}); }

  Gyro gyro{ArcModel::kExact, std::chrono::seconds(1)};
  Motion last;
  double theta_rad = 0.0;  // not wrapped
  double variance_rad2 = 0.0;
  double odometry_variance_rad2 = 0.0;

 private:
  double noise_radps_;
  RandomStream random_;
  int steps_ = 0;
};

TEST(Gyro, IsBelievedOnceItTurnsAsTheOdometry) {
  GyroRobot robot;
  robot.stand(5.0);
  robot.drive({0.5, 0.5, 0.4});
  EXPECT_FALSE(robot.gyro.findings().is_believed);
  EXPECT_NEAR(robot.theta_rad, 0.25, 1e-9);
  robot.drive({3.5, 0.5, 0.4});
  EXPECT_TRUE(robot.gyro.findings().is_believed);
  EXPECT_NEAR(robot.theta_rad, 1.0 * 0.5 + 3.0 * 0.4, 0.01) << "after a second";
}

TEST(Gyro, LearnsItsBiasWhileTheWheelsStand) {
  constexpr double kBias_radps = 0.03;
  GyroRobot robot;
  robot.stand(5.0, kBias_radps);
  EXPECT_NEAR(robot.gyro.findings().bias_radps, kBias_radps, 1e-3);
  EXPECT_LT(robot.gyro.findings().bias_sigma_radps, 1e-3);
  robot.drive({4.0, 0.5, 0.5 + kBias_radps});
  robot.drive({20.0, 0.0, kBias_radps});
  EXPECT_NEAR(robot.theta_rad, 2.0, 0.02);
}

TEST(Gyro, WhatTurnsAStandingRobotIsNoBias) {
  GyroRobot robot;
  robot.stand(5.0);
  robot.drive({4.0, 0.5, 0.5});
  robot.stand(5.0, 0.3);
  EXPECT_NEAR(robot.gyro.findings().bias_radps, 0.0, 1e-3);
  EXPECT_NEAR(robot.theta_rad, 2.0 + 1.5, 0.02) << "it was turned";
}

TEST(Gyro, LearnsItsBiasOnStraightLinesWhereTheWheelsNeverStand) {
  constexpr double kBias_radps = 0.02;
  GyroRobot robot;
  robot.drive({100.0, 0.0, kBias_radps});
  EXPECT_FALSE(robot.gyro.findings().has_stood);
  EXPECT_NEAR(robot.gyro.findings().bias_radps, kBias_radps, 0.005);
}

TEST(Gyro, IsSurerOfTheHeadingThanTheOdometryAndNotTooSure) {
  constexpr int kRuns = 200;
  const double noise_radps = to_radians(0.03) / std::sqrt(kGyroStep_s);
  double sum_rad2 = 0.0;
  double variance_rad2 = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    GyroRobot robot(noise_radps, seed);
    robot.stand(3.0);
    robot.drive({2.0, 0.5, 0.5});
    const double before_rad = robot.theta_rad;
    robot.variance_rad2 = robot.odometry_variance_rad2 = 0.0;
    robot.drive({40.0, 0.2, 0.2});
    EXPECT_LT(robot.variance_rad2, 0.5 * robot.odometry_variance_rad2);
    sum_rad2 += std::pow(robot.theta_rad - before_rad - 8.0, 2) / kRuns;
    variance_rad2 += robot.variance_rad2 / kRuns;
  }
  EXPECT_LT(sum_rad2, 1.3 * variance_rad2) << "three standard deviations of a sample variance";
}

TEST(Gyro, HoldsTheHeadingWhereTheWheelsSlip) {
  GyroRobot robot;
  robot.stand(5.0);
  robot.drive({4.0, 0.5, 0.5});
  robot.drive({2.0, 1.5, 0.2});
  robot.drive({2.0, 0.0, 0.0});
  EXPECT_NEAR(robot.theta_rad, 2.4, 0.02);
  EXPECT_EQ(robot.gyro.findings().slips.count, 1);
  EXPECT_NEAR(to_seconds(robot.gyro.findings().slips.first), 9.5, 0.51);
}

TEST(Gyro, FindsItsSignAndDegrees) {
  for (const double factor : {-1.0, 180.0 / kPi, -180.0 / kPi}) {
    GyroRobot robot(1e-4 * std::abs(factor));
    robot.stand(5.0);
    robot.drive({4.0, 0.5, factor * 0.5});
    robot.drive({4.0, -0.5, factor * -0.45});
    EXPECT_NEAR(robot.gyro.findings().factor, 1.0 / factor, 1e-12);
    EXPECT_NEAR(robot.theta_rad, 2.0 - 4.0 * 0.45, 0.03) << factor;
  }
}

TEST(Gyro, ThatIsDeadChangesNothing) {
  GyroRobot robot(0.0);
  robot.stand(2.0);
  robot.drive({20.0, 0.5, 0.0});
  EXPECT_FALSE(robot.gyro.findings().is_believed);
  EXPECT_TRUE(robot.gyro.findings().is_constant);
  EXPECT_NEAR(robot.gyro.findings().ratio.value(), 0.0, 1e-3);
  const Motion told = velocity_motion({kV_mps, 0.5}, kGyroStep_s, {});
  EXPECT_EQ(robot.last.increment, told.increment);
  EXPECT_EQ(robot.last.covariance, told.covariance);
}

TEST(Gyro, ThatGetsStuckIsLeftToTheOdometryFromThenOn) {
  GyroRobot robot;
  robot.stand(5.0);
  robot.drive({4.0, 0.5, 0.5});
  robot.make_stuck();
  robot.drive({4.0, -0.5, 0.3});
  EXPECT_EQ(robot.gyro.findings().stuck.count, 1);
  EXPECT_NEAR(robot.theta_rad, 0.0, 0.05);
}

TEST(Gyro, IsBelievedBesideOdometryThatNeverTurns) {
  GyroRobot robot;
  robot.drive({10.0, 0.0, 0.3});
  EXPECT_TRUE(robot.gyro.findings().is_believed);
  EXPECT_FALSE(robot.gyro.findings().odometry_turns);
  EXPECT_NEAR(robot.theta_rad, 3.0, 0.1);
}

TEST(Gyro, HoldsTheHeadingWhereTheOdometryIsMissing) {
  GyroRobot robot;
  robot.stand(5.0);
  robot.drive({4.0, 0.5, 0.5});
  robot.drive({2.0, 0.0, 0.4, 0.0}, false);
  EXPECT_NEAR(robot.theta_rad, 2.8, 0.02);
  EXPECT_NEAR(robot.gyro.findings().bias_radps, 0.0, 1e-3);
}

}  // namespace
}  // namespace waymark
