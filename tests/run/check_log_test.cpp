#include "workbench/run/check_log.hpp"

#include <gtest/gtest.h>

#include "run/circle_sample.hpp"

namespace waymark {
namespace {

using test::circle_sample;
using test::told_pose;

TEST(CheckLog, BelievesUnitsWhereEverythingFits) {
  const auto unwrapped = circle_sample(told_pose, [](RangeBearing z, const Pose2&) {
    return RangeBearing{z.range_m, z.bearing_rad + 40.0 * kPi};
  });
  EXPECT_TRUE(contradictions_in(unwrapped, {}).empty());
}

TEST(CheckLog, NamesWhatExplainsAContradictionAndNothingElse) {
  const auto degrees = circle_sample(told_pose, [](RangeBearing z, const Pose2&) {
    return RangeBearing{z.range_m, to_degrees(z.bearing_rad)};
  });
  const auto lines = contradictions_in(degrees, {});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("contradict"), std::string::npos);
}

TEST(CheckLog, JudgesTheNumbersAloneWhereNothingCanBeCompared) {
  auto degrees = circle_sample(told_pose, [](RangeBearing z, const Pose2&) {
    return RangeBearing{z.range_m, to_degrees(z.bearing_rad)};
  });
  for (auto& observed : degrees.observations) observed.id.reset();
  const auto lines = contradictions_in(degrees, {});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("in degrees?"), std::string::npos);
}

TEST(CheckLog, SaysWhatOdometryCouldHaveBeen) {
  LogInfo bag;
  bag.topics.push_back({"/scan", "sensor_msgs/LaserScan", 1, ""});
  EXPECT_NE(describe_missing_odometry({}).find("wheels.csv"), std::string::npos);
  EXPECT_NE(describe_missing_odometry(bag).find("nav_msgs/Odometry"), std::string::npos);
}

}  // namespace
}  // namespace waymark
