#include "workbench/run/check_gyro.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include "run/circle_sample.hpp"
#include "workbench/run/recording.hpp"

namespace waymark {
namespace {

using test::circle_sample;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// The circle, and a gyro that tells so much of its 0.2 rad/s.
std::vector<std::string> said_of_gyro(double times,
                                      const LogSample& odometry = circle_sample(test::told_pose),
                                      const Config& config = {}) {
  LogSample sample = odometry;
  for (int i = 0; i < 6000; ++i)
    sample.add(Event(stamp_from_seconds(0.01 * i), YawRate{times * (0.2 + (i % 2 == 0 ? 1e-4 : -1e-4))}), {});
  return describe(gyro_of(sample, config), Stamp{});
}

TEST(CheckGyro, SaysNothingWithoutOne) {
  EXPECT_THAT(describe(gyro_of(circle_sample(test::told_pose), {}), Stamp{}), IsEmpty());
}

TEST(CheckGyro, SaysThatItHoldsTheHeading) {
  EXPECT_THAT(said_of_gyro(0.97), ElementsAre(HasSubstr("the heading is held by the gyro")));
}

TEST(CheckGyro, NamesDegreesAndTheSign) {
  EXPECT_THAT(said_of_gyro(180.0 / kPi),
              ElementsAre(HasSubstr("held by the gyro"), HasSubstr("it is taken as degrees per second; it")));
  EXPECT_THAT(said_of_gyro(-1.0), ElementsAre(HasSubstr("held by the gyro"),
                                              HasSubstr("-1 times as much as the odometry: its sign")));
}

TEST(CheckGyro, SaysWhyItIsNotUsed) {
  EXPECT_THAT(said_of_gyro(0.0),
              ElementsAre(HasSubstr("not used, and the heading is the odometry's: it tells "
                                    "the same rate all the time")));
  EXPECT_THAT(said_of_gyro(0.2), ElementsAre(HasSubstr("it turns 0.2 times as much as the odometry")));
}

TEST(CheckGyro, SaysNothingWhereTheWheelsAreNotKnown) {
  const auto wheels = circle_sample([](double t_s, const Pose2&) { return test::circle_wheels(t_s); });
  EXPECT_THAT(said_of_gyro(1.0, wheels), IsEmpty());
}

/// Two laps with wheels that slip in turns.
Recording record_slipping(FilterKind filter, const std::vector<std::string>& more) {
  UserSettings user{
      .assignments = {"sim.turn_slip_ratio=0.4", "sim.stand_s=3", "sim.wheel_var_m2_per_m=2e-5"}};
  user.assignments.insert(user.assignments.end(), more.begin(), more.end());
  auto opened = open_input("sim:study", user);
  EXPECT_TRUE(opened.ok()) << opened.error().message;
  opened->config.filter = filter;
  auto recording = record(*opened->source, opened->config);
  EXPECT_TRUE(recording.ok()) << recording.error().message;
  return *std::move(recording);
}

/// Largest error of the heading by the odometry alone.
double heading_error_rad(const Recording& recording) {
  double worst_rad = 0.0;
  for (const auto& [stamp, truth] : recording.truth) {
    const auto at = std::ranges::find(recording.dead_reckoning, stamp, &TrajectoryPoint::stamp);
    if (at == recording.dead_reckoning.end()) continue;
    const double start_rad = recording.truth.front().second.theta_rad.value();
    worst_rad = std::max(worst_rad, std::abs(wrap_angle(*truth.theta_rad - start_rad - at->pose.theta_rad)));
  }
  return worst_rad;
}

TEST(CheckGyro, HoldsTheHeadingOfASimulatedRobotWhoseWheelsSlip) {
  const Recording without = record_slipping(FilterKind::kEkf, {});
  const Recording with = record_slipping(FilterKind::kEkf, {"sim.gyro_rate_hz=100"});
  EXPECT_GT(heading_error_rad(without), 0.5);
  EXPECT_LT(heading_error_rad(with),
            0.3);  // the wheels' on the first straight line, and a part of the first turn
  EXPECT_TRUE(with.counts.gyro.has_stood);
  EXPECT_THAT(with.notes, testing::Contains(HasSubstr("the heading is held by the gyro")));
}

TEST(CheckGyro, AStuckGyroOfASimulatedRobotIsSaid) {
  const Recording stuck = record_slipping(
      FilterKind::kFastSlam, {"sim.gyro_rate_hz=100", "sim.gyro_stuck_at_s=60", "fastslam.particles=10"});
  EXPECT_THAT(stuck.notes, testing::Contains(HasSubstr("the gyro is stuck")));
}

}  // namespace
}  // namespace waymark
