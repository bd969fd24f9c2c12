#include "workbench/run/check_units.hpp"

#include <gtest/gtest.h>

#include "run/circle_sample.hpp"

namespace waymark {
namespace {

using test::circle_sample;
using test::told_pose;

/// The only line, or all of them.
std::string units_said_of(const LogSample& sample) {
  std::string all;
  for (const auto& line : check_units(sample, {})) all += line;
  return all;
}

bool units_name(const std::string& line, const std::string& what) {
  return line.find(what) != std::string::npos;
}

/// The same with other stamps.
LogSample restamped(LogSample sample, double odometry_factor, double observation_factor) {
  for (Event& event : sample.odometry)
    event.stamp = stamp_from_seconds(odometry_factor * to_seconds(event.stamp));
  for (auto& observed : sample.observations)
    observed.stamp = stamp_from_seconds(observation_factor * to_seconds(observed.stamp));
  return sample;
}

TEST(CheckUnits, SaysNothingOfARightLog) { EXPECT_EQ(units_said_of(circle_sample(told_pose)), ""); }

TEST(CheckUnits, NamesBearingsBeyondATurn) {
  const auto sample = circle_sample(told_pose, [](RangeBearing z, const Pose2&) {
    return RangeBearing{z.range_m, to_degrees(z.bearing_rad)};
  });
  EXPECT_TRUE(units_name(units_said_of(sample), "in degrees?")) << units_said_of(sample);
}

TEST(CheckUnits, NamesRangesOutsideOfTheLimits) {
  const auto sample = circle_sample(told_pose, [](RangeBearing z, const Pose2&) {
    return RangeBearing{1000.0 * z.range_m, z.bearing_rad};
  });
  EXPECT_TRUE(units_name(units_said_of(sample), "sensor.max_range_m = 1000: are they in millimetres?"))
      << units_said_of(sample);
}

TEST(CheckUnits, NamesSpeedsAndTurnRatesOfNoRobot) {
  const auto poses = circle_sample([](double, const Pose2& pose) {
    return OdometryPose{{100.0 * pose.x_m, 100.0 * pose.y_m, pose.theta_rad}};
  });
  const auto rates = circle_sample([](double, const Pose2&) { return Velocity{0.4, 28.6}; });
  EXPECT_TRUE(units_name(units_said_of(poses), "speeds of 40 m/s")) << units_said_of(poses);
  EXPECT_TRUE(units_name(units_said_of(rates), "turns at 29 rad/s")) << units_said_of(rates);
}

TEST(CheckUnits, NamesStampsInMilliseconds) {
  const auto both = restamped(circle_sample(told_pose), 1000.0, 1000.0);
  const auto one = restamped(circle_sample(told_pose), 1.0, 1000.0);
  EXPECT_TRUE(units_name(units_said_of(both), "every 50 s: are stamps in milliseconds?"))
      << units_said_of(both);
  EXPECT_TRUE(units_name(units_said_of(one), "lasts 60 s and the observations 6e+04 s"))
      << units_said_of(one);
}

}  // namespace
}  // namespace waymark
