#include "workbench/study/observation_score.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "waymark/core/angle.hpp"

namespace waymark::study {
namespace {

constexpr double kField = -4.0;

Innovation compared(double log_density) {
  Innovation innovation;
  innovation.dof = 2;
  innovation.log_density = log_density;
  return innovation;
}

TEST(ObservationScore, IsTheMixtureOfWhatWasExpectedAndOfAnything) {
  for (const double log_density : {-30.0, -5.0, 0.0, 4.0})
    EXPECT_NEAR(log_likelihood(compared(log_density), kField),
                std::log(0.99 * std::exp(log_density) + 0.01 * std::exp(kField)), 1e-12);
}

TEST(ObservationScore, AnOutlierCostsTheSameHoweverFarOutItIs) {
  const double floor = std::log(0.01) + kField;
  EXPECT_DOUBLE_EQ(log_likelihood(compared(-1e4), kField), floor);
  EXPECT_DOUBLE_EQ(log_likelihood(compared(-1e300), kField), floor);
  EXPECT_DOUBLE_EQ(log_likelihood(compared(-HUGE_VAL), kField), floor);
}

TEST(ObservationScore, WhatTheFilterDidWithItDoesNotMatter) {
  Innovation gated = compared(-3.0);
  gated.outcome = Outcome::kGated;
  Innovation matched = compared(-3.0);
  matched.outcome = Outcome::kMatched;
  EXPECT_EQ(log_likelihood(gated, kField), log_likelihood(matched, kField));
}

TEST(ObservationScore, WhatWasComparedWithNothingIsAsLikelyAsAnything) {
  for (const Outcome outcome : {Outcome::kAdded, Outcome::kDeferred, Outcome::kDuplicate}) {
    Innovation innovation;
    innovation.outcome = outcome;
    EXPECT_EQ(log_likelihood(innovation, kField), kField);
  }
}

TEST(ObservationScore, AnythingIsEvenOverWhatTheSensorCanSay) {
  Config config;
  EXPECT_NEAR(std::exp(log_field_density(config, 5.0)) * 5.0 * 2.0 * kPi, 1.0, 1e-12);
  config.observe = Observe::kRange;
  EXPECT_NEAR(std::exp(log_field_density(config, 5.0)) * 5.0, 1.0, 1e-12);
  config.observe = Observe::kBearing;
  EXPECT_NEAR(std::exp(log_field_density(config, 0.0)) * 2.0 * kPi, 1.0, 1e-12);
  config.observe = Observe::kPixel;
  EXPECT_NEAR(std::exp(log_field_density(config, 0.0)) * config.camera.width_px * config.camera.height_px,
              1.0, 1e-12);
}

}  // namespace
}  // namespace waymark::study
