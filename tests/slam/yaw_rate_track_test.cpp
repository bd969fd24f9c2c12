#include "waymark/slam/yaw_rate_track.hpp"

#include <gtest/gtest.h>

#include "support/stamps.hpp"

namespace waymark {
namespace {

using test::at;

TEST(YawRateTrack, KnowsNothingBeforeTheFirstReading) {
  EXPECT_EQ(YawRateTrack(std::chrono::seconds(1)).turn_rad(at(0.0), at(1.0), nullptr), std::nullopt);
}

TEST(YawRateTrack, IntegratesWhatIsLinearBetweenReadings) {
  YawRateTrack track(std::chrono::seconds(1));
  track.add(at(1.0), {2.0});
  const Event next{at(2.0), YawRate{4.0}};
  EXPECT_NEAR(track.turn_rad(at(1.0), at(2.0), &next).value(), 3.0, 1e-12);
  EXPECT_NEAR(track.turn_rad(at(1.5), at(2.0), &next).value(), 0.5 * 3.5, 1e-12);
}

TEST(YawRateTrack, HoldsTheLastReadingNoLongerThanItMay) {
  YawRateTrack track(std::chrono::seconds(1));
  track.add(at(1.0), {2.0});
  EXPECT_NEAR(track.turn_rad(at(1.0), at(1.5), nullptr).value(), 1.0, 1e-12);
  EXPECT_EQ(track.turn_rad(at(1.0), at(2.5), nullptr), std::nullopt);
}

}  // namespace
}  // namespace waymark
