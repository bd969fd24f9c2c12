#include "workbench/study/tune_text.hpp"

#include <gmock/gmock.h>

namespace waymark::study {
namespace {

using testing::HasSubstr;

TEST(TuneText, IsAConfig) {
  TuneResult result{
      .keys = {{.name = "sensor.range_sigma_m", .before = 0.1, .after = 0.2, .interval = {{0.15, 0.25}}},
               {.name = "motion.turn_scale", .before = 1.0, .after = 0.98},
               {.name = "sensor.bearing_sigma_deg",
                .before = 1.0,
                .after = 1e-3,
                .interval = {{1e-3, 0.5}},
                .open_low = true}},
      .observations = 7,
      .before = -1.0,
      .after = 2.0};
  const std::string yaml = to_yaml(result);
  Config config;
  ASSERT_TRUE(describe(config).load_text(yaml, "tuned.yaml").ok()) << yaml;
  EXPECT_EQ(config.sensor.range_sigma_m, 0.2);
  EXPECT_EQ(config.sensor.bearing_sigma_deg, 1e-3);
  EXPECT_EQ(config.odometry.turn_scale, 0.98);
  EXPECT_THAT(yaml, HasSubstr("range_sigma_m: 0.2  # was 0.1; 0.15 to 0.25"));
  EXPECT_THAT(yaml, HasSubstr("# was 1; below 0.5"));
}

TEST(TuneText, SaysWhereALogDoesNotTell) {
  TunedKey key{.name = "a.b"};
  EXPECT_EQ(interval_text(key), "");
  key.interval = {{0.1, 0.2}};
  EXPECT_EQ(interval_text(key), "0.1 to 0.2");
  key.open_high = true;
  EXPECT_EQ(interval_text(key), "above 0.1");
  key.open_low = true;
  EXPECT_THAT(interval_text(key), HasSubstr("not observable"));
}

}  // namespace
}  // namespace waymark::study
