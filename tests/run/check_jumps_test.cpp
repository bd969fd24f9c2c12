#include "workbench/run/check_jumps.hpp"

#include <gtest/gtest.h>

#include "run/circle_sample.hpp"

namespace waymark {
namespace {

using test::circle_sample;
using test::told_pose;

TEST(CheckJumps, FindsNoneInARightLog) {
  EXPECT_TRUE(describe(jumps_of(circle_sample(told_pose), {}), Stamp{}).empty());
}

TEST(CheckJumps, SaysWhenAndHowOften) {
  const auto sample = circle_sample([](double t_s, const Pose2& pose) {
    const bool is_reset = t_s > 9.99 && t_s < 10.06;
    return OdometryPose{is_reset ? Pose2{} : Pose2{0.0, t_s > 20.01 ? 30.0 : 0.0, 0.0} * pose};
  });
  const auto lines = describe(jumps_of(sample, {}), stamp_from_seconds(1.0));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_NE(lines[0].find("jumps once, at 19.05 s"), std::string::npos) << lines[0];
  EXPECT_NE(lines[1].find("2 times, first at 9.00 s"), std::string::npos) << lines[1];
}

TEST(CheckJumps, NamesAnglesThatWrap) {
  Config config;
  config.odometry.wheels = {0.1, 0.1, 0.3};
  const auto sample = circle_sample([](double t_s, const Pose2&) {
    const WheelAngles angles = test::circle_wheels(t_s);
    return WheelAngles{wrap_angle(angles.left_rad), wrap_angle(angles.right_rad)};
  });
  const auto lines = describe(jumps_of(sample, config), Stamp{});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("wrap"), std::string::npos) << lines[0];
}

}  // namespace
}  // namespace waymark
