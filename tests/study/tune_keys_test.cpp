#include "workbench/study/tune_keys.hpp"

#include <gmock/gmock.h>

namespace waymark::study {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string refusal(const std::string& key) {
  const auto keys = tune_keys(Config{}, {key});
  return keys ? "accepted" : keys.error().message;
}

TEST(TuneKeys, StartWhereTheConfigIsAndKeepToTheirLimits) {
  Config config;
  config.sensor.range_sigma_m = 0.2;
  const auto keys = tune_keys(config, {"sensor.range_sigma_m", "motion.turn_scale"});
  ASSERT_TRUE(keys.ok()) << keys.error().message;
  const TuneKey& sigma = (*keys)[0];
  EXPECT_TRUE(sigma.by_factor);
  EXPECT_DOUBLE_EQ(sigma.start, 0.2);
  EXPECT_DOUBLE_EQ(sigma.low, 2e-4);
  EXPECT_DOUBLE_EQ(sigma.high, 200.0);
  EXPECT_DOUBLE_EQ((*keys)[1].low, 0.1);  // the key's own limits are nearer
  EXPECT_DOUBLE_EQ((*keys)[1].high, 10.0);
}

TEST(TuneKeys, WhatMayBeNegativeIsSearchedAsItIs) {
  const auto keys = tune_keys(Config{}, {"sensor.range_offset_m"});
  ASSERT_TRUE(keys.ok());
  EXPECT_FALSE(keys->front().by_factor);
  EXPECT_DOUBLE_EQ(keys->front().to_value(keys->front().to_search(-0.25)), -0.25);
  EXPECT_GT(keys->front().first_step(), 0.0);
}

TEST(TuneKeys, ValuesAreWhatAConfigFileWillSay) {
  const TuneKey key{"sensor.range_sigma_m", 0.1, 1e-4, 100.0, true};
  const double value = key.to_value(key.to_search(0.1234567));
  EXPECT_DOUBLE_EQ(value, 0.1235);
  EXPECT_EQ(tuned_text(value), "0.1235");
  EXPECT_THAT(assignments({key}, {key.to_search(0.1234567)}), ElementsAre("sensor.range_sigma_m=0.1235"));
  EXPECT_DOUBLE_EQ(key.to_value(key.to_search(1e6)), 100.0);
}

TEST(TuneKeys, RefuseWhatCannotBeTuned) {
  EXPECT_THAT(refusal("sensor.range_sigma"), HasSubstr("close keys: sensor.range_sigma_m"));
  EXPECT_THAT(refusal("qqqqqqqqqqqqqqq"), HasSubstr("waymark config"));
  EXPECT_THAT(refusal("filter"), HasSubstr("not a real number"));
  EXPECT_THAT(refusal("fastslam.particles"), HasSubstr("not a real number"));
  EXPECT_THAT(refusal("sim.range_sigma_m"), HasSubstr("changes what is in the log"));
  EXPECT_THAT(refusal("input.pixel_noise_px"), HasSubstr("changes what is in the log"));
  EXPECT_THAT(refusal("sensor.range_sigma_ratio"), HasSubstr("--set sensor.range_sigma_ratio=0.01"));
  const auto twice = tune_keys(Config{}, {"sensor.range_sigma_m", "sensor.range_sigma_m"});
  ASSERT_FALSE(twice.ok());
  EXPECT_THAT(twice.error().message, HasSubstr("twice"));
}

TEST(TuneKeys, DefaultsAreTheNoiseOfWhatTheLogHas) {
  Config config;
  EXPECT_THAT(default_tune_keys(config, OdometryKind::kWheels),
              ElementsAre("motion.wheel_var_m2_per_m", "motion.turn_var_rad2_per_rad", "sensor.range_sigma_m",
                          "sensor.bearing_sigma_deg"));
  config.observe = Observe::kRange;
  config.sensor.range_sigma_ratio = 0.01;
  EXPECT_THAT(default_tune_keys(config, std::nullopt),
              ElementsAre("sensor.range_sigma_m", "sensor.range_sigma_ratio"));
}

TEST(TuneKeys, AllDefaultsCanBeTuned) {
  Config config;
  for (const Observe observe :
       {Observe::kRangeBearing, Observe::kRange, Observe::kBearing, Observe::kPixel, Observe::kMarkers})
    for (const OdometryKind odometry :
         {OdometryKind::kWheels, OdometryKind::kVelocity, OdometryKind::kSteering, OdometryKind::kPose}) {
      config.observe = observe;
      const auto names = default_tune_keys(config, odometry);
      EXPECT_GE(names.size(), 3U);
      EXPECT_TRUE(tune_keys(config, names).ok()) << describe(odometry);
    }
}

}  // namespace
}  // namespace waymark::study
