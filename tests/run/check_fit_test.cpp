#include "workbench/run/check_fit.hpp"

#include <gtest/gtest.h>

#include "run/circle_sample.hpp"

namespace waymark {
namespace {

using test::circle_sample;
using test::circle_wheels;
using test::told_pose;
using test::told_velocity;

Config config_with_wheels() {
  Config config;
  config.odometry.wheels = {0.1, 0.1, 0.3};
  return config;
}

/// What is said of it.
std::string fit_said_of(const LogSample& sample) {
  const auto fit = fit_of(sample, config_with_wheels());
  return fit ? describe(*fit).value_or("fits") : "unknown";
}

bool fit_names(const std::string& line, const std::string& what) {
  return line.find(what) != std::string::npos;
}

TEST(CheckFit, FindsThatARightLogFits) {
  EXPECT_EQ(fit_said_of(circle_sample(told_pose)), "fits");
  EXPECT_EQ(fit_said_of(circle_sample(told_velocity)), "fits");
  EXPECT_EQ(fit_said_of(circle_sample([](double t_s, const Pose2&) { return circle_wheels(t_s); })), "fits");
}

TEST(CheckFit, NamesAWheelThatCountsDown) {
  const auto left = circle_sample([](double t_s, const Pose2&) {
    return WheelAngles{-circle_wheels(t_s).left_rad, circle_wheels(t_s).right_rad};
  });
  const auto right = circle_sample([](double t_s, const Pose2&) {
    return WheelAngles{circle_wheels(t_s).left_rad, -circle_wheels(t_s).right_rad};
  });
  EXPECT_TRUE(fit_names(fit_said_of(left), "if the left wheel has the wrong sign")) << fit_said_of(left);
  EXPECT_TRUE(fit_names(fit_said_of(right), "if the right wheel has the wrong sign")) << fit_said_of(right);
}

TEST(CheckFit, NamesExchangedWheels) {
  const auto sample = circle_sample([](double t_s, const Pose2&) {
    return WheelAngles{circle_wheels(t_s).right_rad, circle_wheels(t_s).left_rad};
  });
  EXPECT_TRUE(fit_names(fit_said_of(sample), "are exchanged (input.left_joint")) << fit_said_of(sample);
}

TEST(CheckFit, NamesClockwiseBearings) {
  const auto sample = circle_sample(told_pose, [](RangeBearing z, const Pose2&) {
    return RangeBearing{z.range_m, -z.bearing_rad};
  });
  EXPECT_TRUE(fit_names(fit_said_of(sample), "clockwise")) << fit_said_of(sample);
}

TEST(CheckFit, NamesOdometryThatPointsDown) {
  const auto sample = circle_sample([](double, const Pose2& pose) {
    return OdometryPose{{pose.x_m, -pose.y_m, -pose.theta_rad}};
  });
  EXPECT_TRUE(fit_names(fit_said_of(sample), "NED")) << fit_said_of(sample);
}

TEST(CheckFit, NamesBearingsInTheWorldFrame) {
  for (const double start_rad : {0.0, 1.0}) {
    const auto sample = circle_sample(told_pose, [start_rad](RangeBearing z, const Pose2& pose) {
      return RangeBearing{z.range_m, wrap_angle(z.bearing_rad + pose.theta_rad + start_rad)};
    });
    EXPECT_TRUE(fit_names(fit_said_of(sample), "the heading was added")) << fit_said_of(sample);
  }
}

TEST(CheckFit, NamesDegrees) {
  const auto bearings = circle_sample(told_velocity, [](RangeBearing z, const Pose2&) {
    return RangeBearing{z.range_m, to_degrees(z.bearing_rad)};
  });
  const auto headings = circle_sample([](double, const Pose2& pose) {
    return OdometryPose{{pose.x_m, pose.y_m, to_degrees(pose.theta_rad)}};
  });
  const auto rates = circle_sample([](double, const Pose2&) { return Velocity{0.4, to_degrees(0.2)}; });
  EXPECT_TRUE(fit_names(fit_said_of(bearings), "if bearings are in degrees")) << fit_said_of(bearings);
  EXPECT_TRUE(fit_names(fit_said_of(headings), "if headings of the odometry are in degrees"))
      << fit_said_of(headings);
  EXPECT_TRUE(fit_names(fit_said_of(rates), "if turn rates are in degrees per second")) << fit_said_of(rates);
}

TEST(CheckFit, NamesUnitsOfLength) {
  const auto odometry = circle_sample([](double, const Pose2& pose) {
    return OdometryPose{{100.0 * pose.x_m, 100.0 * pose.y_m, pose.theta_rad}};
  });
  const auto ranges = circle_sample(told_pose, [](RangeBearing z, const Pose2&) {
    return RangeBearing{1000.0 * z.range_m, z.bearing_rad};
  });
  EXPECT_TRUE(fit_names(fit_said_of(odometry), "if lengths of the odometry are in centimetres"))
      << fit_said_of(odometry);
  EXPECT_TRUE(fit_names(fit_said_of(ranges), "if ranges are in millimetres")) << fit_said_of(ranges);
}

TEST(CheckFit, NamesASensorThatLooksBackwards) {
  const auto sample = circle_sample(told_pose, [](RangeBearing z, const Pose2&) {
    return RangeBearing{z.range_m, wrap_angle(z.bearing_rad + kPi)};
  });
  EXPECT_TRUE(fit_names(fit_said_of(sample), "sensor.yaw_deg=180")) << fit_said_of(sample);
}

TEST(CheckFit, SaysThatNothingKnownExplainsAContradiction) {
  const auto sample = circle_sample(told_pose, [](RangeBearing, const Pose2& pose) {
    return RangeBearing{2.0 + std::sin(40.0 * pose.x_m), 3.0 * std::sin(70.0 * pose.y_m)};
  });
  EXPECT_TRUE(fit_names(fit_said_of(sample), "no known mistake")) << fit_said_of(sample);
}

TEST(CheckFit, KnowsNothingOfALogWithoutIdentitiesOrWheels) {
  auto sample = circle_sample([](double t_s, const Pose2&) { return circle_wheels(t_s); });
  EXPECT_FALSE(fit_of(sample, Config{}).has_value());
  for (auto& observed : sample.observations) observed.id.reset();
  EXPECT_FALSE(fit_of(sample, config_with_wheels()).has_value());
}

}  // namespace
}  // namespace waymark
