#include "workbench/live/light.hpp"

#include <gmock/gmock.h>

namespace waymark::live {
namespace {

using testing::HasSubstr;

StreamSummary wheels() {
  StreamSummary stream;
  stream.name = "wheels";
  stream.received = 1000;
  stream.rate_hz = 30.0;
  stream.silent_s = 0.02;
  stream.brings_motion = true;
  return stream;
}

StreamSummary camera() {
  StreamSummary stream = wheels();
  stream.name = "camera";
  stream.brings_motion = false;
  return stream;
}

TEST(Light, IsGoodWhereAllIsWell) {
  const Light light = judge_now(std::vector{wheels(), camera()}, {}, 0.5);
  EXPECT_EQ(light.level, Trust::kGood);
  EXPECT_TRUE(light.reasons.empty());
}

TEST(Light, NamesAStreamThatFellSilentWithinASecond) {
  auto silent = camera();
  silent.silent_s = 1.0;
  const Light light = judge_now(std::vector{wheels(), silent}, {}, 0.5);
  EXPECT_EQ(light.level, Trust::kUnsure);
  ASSERT_EQ(light.reasons.size(), 1U);
  EXPECT_THAT(light.reasons[0], HasSubstr("camera: silent for 1.0 s"));
}

TEST(Light, LeavesSlowStreamsTheirPace) {
  auto slow = camera();
  slow.rate_hz = 0.5;
  slow.silent_s = 3.0;
  EXPECT_EQ(judge_now(std::vector{wheels(), slow}, {}, 0.5).level, Trust::kGood);
}

TEST(Light, TrustsNothingWithoutOdometry) {
  auto gone = wheels();
  gone.fault = "No such device";
  const Light light = judge_now(std::vector{gone, camera()}, {}, 0.5);
  EXPECT_EQ(light.level, Trust::kDoNotTrust);
  EXPECT_THAT(light.reasons[0], HasSubstr("no odometry"));
  EXPECT_THAT(light.reasons[1], HasSubstr("No such device"));
}

TEST(Light, SaysThatTheRobotIsLostFirst) {
  auto damaged = wheels();
  damaged.bad = 50;
  const Light light = judge_now(std::vector{damaged}, {.lost = true}, 0.5);
  EXPECT_EQ(light.level, Trust::kDoNotTrust);
  EXPECT_THAT(light.reasons[0], HasSubstr("lost"));
  EXPECT_THAT(light.reasons[1], HasSubstr("5 % is damaged"));
}

TEST(Light, MissesLandmarks) {
  EXPECT_THAT(judge_now(std::vector{wheels()}, {}, std::nullopt).reasons[0], HasSubstr("yet"));
  EXPECT_THAT(judge_now(std::vector{wheels()}, {}, 14.2).reasons[0], HasSubstr("no landmark for 14 s"));
}

}  // namespace
}  // namespace waymark::live
