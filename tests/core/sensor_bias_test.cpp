#include "waymark/core/sensor_bias.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(CalibrationEstimate, TellsWhatWasLearntFromWhatWasAssumed) {
  CalibrationEstimate estimate;
  estimate.prior_sigmas[kSpeedScale] = estimate.prior_sigmas[kTurnScale] = 0.1;
  estimate.sigmas[kSpeedScale] = 0.02;
  estimate.sigmas[kTurnScale] = 0.099;
  EXPECT_TRUE(estimate.is_estimated(kSpeedScale));
  EXPECT_FALSE(estimate.is_unobservable(kSpeedScale));
  EXPECT_TRUE(estimate.is_unobservable(kTurnScale));
  EXPECT_FALSE(estimate.is_estimated(kRangeScale));
  EXPECT_FALSE(estimate.is_unobservable(kRangeScale));
}

}  // namespace
}  // namespace waymark
