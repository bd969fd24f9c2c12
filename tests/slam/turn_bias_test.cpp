#include "waymark/slam/turn_bias.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(TurnBias, IsTheMeanRateOfTheTimeThatTheRobotStood) {
  TurnBias bias({0.05, 0.02});
  EXPECT_EQ(bias.rate_radps(), 0.0);
  bias.observe({0.001, 0.0, 0.001}, 0.1);
  EXPECT_NEAR(bias.rate_radps(), 0.01, 1e-15);
  bias.observe({0.0, 0.002, 0.0}, 0.3);
  EXPECT_NEAR(bias.rate_radps(), 0.0025, 1e-15);
}

TEST(TurnBias, IsNotToBeHadFromARobotThatMoves) {
  TurnBias bias({0.05, 0.02});
  bias.observe({0.0051, 0.0, 0.001}, 0.1);   // drives
  bias.observe({0.001, 0.0, -0.0021}, 0.1);  // turns
  EXPECT_EQ(bias.rate_radps(), 0.0);
}

TEST(TurnBias, AGapIsNoStanding) {
  TurnBias bias({0.05, 0.02});
  bias.observe({0.0, 0.0, 0.001}, 0.1);
  bias.observe({}, 100.0);
  EXPECT_NEAR(bias.rate_radps(), 0.01, 1e-15);
}

TEST(TurnBias, IsNotLearntUnlessItIsSaidWhatStandingIs) {
  TurnBias bias({});
  bias.observe({0.0, 0.0, 1e-9}, 0.1);
  EXPECT_EQ(bias.rate_radps(), 0.0);
}

}  // namespace
}  // namespace waymark
