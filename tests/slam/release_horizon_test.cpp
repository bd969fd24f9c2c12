#include "waymark/slam/release_horizon.hpp"

#include <gtest/gtest.h>

#include "support/stamps.hpp"

namespace waymark {
namespace {

constexpr StreamId kWheels{0, 1};
constexpr StreamId kCamera{0, 2};

using test::at;

TEST(ReleaseHorizon, IsThatOfTheStreamThatToldLeast) {
  ReleaseHorizon horizon;
  EXPECT_EQ(horizon.stamp(), std::nullopt);
  horizon.advance(kWheels, at(3.0));
  horizon.advance(kCamera, at(2.0));
  EXPECT_EQ(horizon.stamp(), at(2.0));
}

TEST(ReleaseHorizon, WaitsForAStreamThatIsExpected) {
  ReleaseHorizon horizon;
  horizon.expect(kCamera, Duration{0});
  horizon.advance(kWheels, at(3.0));
  EXPECT_EQ(horizon.stamp(), std::nullopt);
  horizon.advance(kCamera, at(1.0));
  EXPECT_EQ(horizon.stamp(), at(1.0));
}

TEST(ReleaseHorizon, StaysBehindAStreamByItsDisorder) {
  ReleaseHorizon horizon;
  horizon.expect(kCamera, std::chrono::milliseconds(500));
  horizon.advance(kCamera, at(2.0));
  horizon.advance(kCamera, at(1.0));  // out of order
  EXPECT_EQ(horizon.stamp(), at(1.5));
}

TEST(ReleaseHorizon, ASilentStreamHoldsNobodyUpUntilItSpeaksAgain) {
  ReleaseHorizon horizon;
  horizon.advance(kWheels, at(3.0));
  horizon.advance(kCamera, at(1.0));
  horizon.release(kCamera);
  EXPECT_EQ(horizon.stamp(), at(3.0));
  horizon.advance(kCamera, at(2.0));
  EXPECT_EQ(horizon.stamp(), at(2.0));
}

}  // namespace
}  // namespace waymark
