#include "workbench/run/dead_reckoning.hpp"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>

namespace waymark {
namespace {

Event at(double seconds, EventContent content) { return {stamp_from_seconds(seconds), std::move(content)}; }

TEST(DeadReckoning, AddsUpPosesVelocitiesAndWheels) {
  std::vector<Event> poses, velocities, wheels;
  for (int i = 0; i <= 20; ++i) {
    const double t = 0.1 * i;
    poses.push_back(at(t, OdometryPose{{5.0 + t, 2.0, 0.0}}));
    velocities.push_back(at(t, Velocity{1.0, 0.0}));
    wheels.push_back(at(t, WheelAngles{10.0 * t, 10.0 * t}));
  }
  Config config;
  config.odometry.wheels = {0.1, 0.1, 0.3};
  for (const auto& events : {poses, velocities, wheels}) {
    const auto path = dead_reckoning(events, config);
    ASSERT_TRUE(path) << path.error().message;
    ASSERT_EQ(path->size(), 21U);
    EXPECT_EQ(path->back().stamp, stamp_from_seconds(2.0));
    EXPECT_NEAR(path->back().pose.x_m, 2.0, 1e-9);
    EXPECT_NEAR(path->back().pose.y_m, 0.0, 1e-9);
  }
}

TEST(DeadReckoning, FollowsTheFirstStreamAndTheGyro) {
  std::vector<Event> events;
  for (int i = 0; i <= 20; ++i) {
    const double t = 0.1 * i;
    events.push_back(at(t, Velocity{1.0, i < 10 ? 0.5 : 0.2}));  // the wheels slip later
    events.push_back(at(t, OdometryPose{{-50.0 * t, 0.0, 0.0}}));
    events.push_back(at(t, YawRate{i % 2 == 0 ? 0.5001 : 0.4999}));
    events.push_back(at(t, Truth{9.0, 9.0, 0.0}));
  }
  const auto path = dead_reckoning(events, Config{});
  ASSERT_TRUE(path) << path.error().message;
  ASSERT_EQ(path->size(), 21U);
  EXPECT_NEAR(path->back().pose.theta_rad, 1.0, 0.06);
  EXPECT_NEAR(path->back().pose.x_m, 2.0 * std::sin(1.0), 0.1);
}

TEST(DeadReckoning, NothingWithoutOdometryAndAnErrorForUnknownWheels) {
  EXPECT_TRUE(dead_reckoning(std::vector<Event>{at(0, Truth{})}, Config{})->empty());
  EXPECT_THAT(dead_reckoning(std::vector<Event>{at(0, WheelAngles{})}, Config{}).error().message,
              testing::HasSubstr("wheels"));
}

}  // namespace
}  // namespace waymark
