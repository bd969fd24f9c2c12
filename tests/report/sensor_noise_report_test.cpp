#include "waymark/report/sensor_noise_report.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "browser.hpp"

namespace waymark {
namespace {

using testing::HasSubstr;

calibrate::SensorNoise sample() {
  calibrate::SensorNoise noise;
  noise.input = "sim:<b>";
  noise.runs = 3;
  noise.settled = true;
  noise.range = {{0.05, 0.001}, {0.01, 0.002}};
  noise.bearing_sigma_deg = {1.5, 0.02};
  for (int i = 1; i <= 5; ++i) {
    noise.ranges.push_back({1.0 * i, 100, 0.001 * i, {0.05 + 0.01 * i, 0.001}});
    noise.bearings.push_back({0.1 * (i - 3), 100, 0.001, {0.026, 0.001}});
  }
  noise.outliers = 4;
  noise.notes = {"what was found still moved"};
  return noise;
}

TEST(SensorNoiseReport, JsonHasEveryFigure) {
  const auto json = nlohmann::json::parse(to_json(sample()));
  EXPECT_EQ(json["found"]["sensor.range_sigma_m"]["value"], 0.05);
  EXPECT_EQ(json["found"]["sensor.bearing_sigma_deg"]["sigma"], 0.02);
  EXPECT_EQ(json["ranges"].size(), 5U);
  EXPECT_EQ(json["outliers"], 4);
}

TEST(SensorNoiseReport, SaysWhereItCannotBeWritten) {
  const auto written = write_results(sample(), "/nowhere", "");
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("/nowhere/calibration.yaml"));
}

#ifdef WAYMARK_CHROMIUM

TEST(SensorPage, ShowsWhatWasFoundAndHowErrorsLie) {
  const test::Page page = test::open_in_browser(render_report(sample(), "waymark calibrate sensor x"));
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(page.title, "used to the end");
  EXPECT_EQ(test::count(page.body, test::kUplot), 2U);
  for (const char* text : {"sensor.range_sigma_ratio", "still moved", "calibrate sensor x", "sim:&lt;b&gt;"})
    EXPECT_THAT(page.body, HasSubstr(text));
}

TEST(SensorPage, OpensWithoutAnything) {
  const test::Page page = test::open_in_browser(render_report(calibrate::SensorNoise{}, ""));
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(test::count(page.body, test::kUplot), 0U);
}

#endif

}  // namespace
}  // namespace waymark
