#include "waymark/association/association_options.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace waymark {
namespace {

constexpr LandmarkSensor kSensor{.min_range_m = 1.0, .max_range_m = 11.0, .field_of_view_deg = 180.0};

TEST(AssociationModel, LogOddsStepsAreThoseOfTheProbabilities) {
  const AssociationModel model({.false_alarm_probability = 0.1}, kSensor);  // 0.9 unless the sensor says
  EXPECT_NEAR(model.seen(), std::log(9.0), 1e-12);
  EXPECT_NEAR(model.missed(), -std::log(9.0), 1e-12);
}

TEST(AssociationModel, OthersAreClutterAndUnknownLandmarks) {
  const AssociationModel model({.clutter_per_scan = 2.0, .landmarks_per_m2 = 0.05}, kSensor);
  // A patch of 1 m by 1 rad at range r covers r square metres.
  EXPECT_NEAR(std::exp(model.log_density_of_others(4.0)), 2.0 / (10.0 * kPi) + 0.05 * 4.0, 1e-12);
}

TEST(AssociationModel, ALandmarkMustExistToBeSeen) {
  LandmarkSensor sensor = kSensor;
  sensor.detection_probability = 0.8;
  const AssociationModel model({}, sensor);
  EXPECT_NEAR(model.log_odds_of_observation(1.0), std::log(4.0), 1e-12);
  EXPECT_NEAR(model.log_odds_of_observation(0.5), std::log(0.4 / 0.6), 1e-12);
}

}  // namespace
}  // namespace waymark
