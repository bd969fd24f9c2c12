#include "workbench/report/log_calibration_report.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "support/browser.hpp"

namespace waymark {
namespace {

using testing::HasSubstr;

calibrate::LogCalibration sample_log() {
  calibrate::LogCalibration c;
  c.input = "sim:<b>";
  c.log.name = "a drive";
  c.passes = 3;
  c.settled = true;
  c.findings = {{{"wheels.track_m", 0.33, 0.002}, 0.3}, {{"sensor.x_m", 0.1, 0.4, true}, 0.1}};
  c.notes = {"not observable in this log: sensor.x_m"};
  for (int i = 0; i < 20; ++i) {
    const Stamp stamp = Stamp{} + duration_from_seconds(i);
    c.smoothed.push_back({stamp, {0.5 * i, 0.0, 0.0}, std::nullopt});
    c.dead_reckoning_before.push_back({stamp, {0.5 * i, 0.01 * i * i, 0.0}, std::nullopt});
    c.dead_reckoning_after.push_back({stamp, {0.5 * i, 0.001 * i * i, 0.0}, std::nullopt});
  }
  const auto reference = eval::TruthTrack::from_trajectory(c.smoothed);
  c.drift = {*calibrate::drift_of(c.dead_reckoning_before, reference),
             *calibrate::drift_of(c.dead_reckoning_after, reference)};
  return c;
}

TEST(LogCalibrationReport, JsonHasEveryFigure) {
  const auto json = nlohmann::json::parse(to_json(sample_log()));
  EXPECT_EQ(json["found"]["wheels.track_m"]["value"], 0.33);
  EXPECT_EQ(json["found"]["wheels.track_m"]["before"], 0.3);
  EXPECT_TRUE(json["found"]["wheels.track_m"]["told"]);
  EXPECT_FALSE(json["found"]["sensor.x_m"]["told"]);
  EXPECT_NEAR(json["drift"]["before"]["final_m"].get<double>(), 3.61, 1e-9);
  EXPECT_NEAR(json["drift"]["after"]["percent"].get<double>(), 3.8, 1e-9);
  EXPECT_FALSE(json.contains("drift_from_truth"));
}

TEST(LogCalibrationReport, TextSaysWhatIsAssumed) {
  const std::string text = to_text(sample_log());
  EXPECT_THAT(text, HasSubstr("(prior: not observable)"));
  EXPECT_THAT(text, HasSubstr("0.33000 +- 0.00200\n"));
  EXPECT_THAT(text, HasSubstr("note: not observable"));
}

TEST(LogCalibrationReport, SaysWhereItCannotBeWritten) {
  const auto written = write_results(sample_log(), "/nowhere", "");
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("/nowhere/calibration.yaml"));
}

#ifdef WAYMARK_CHROMIUM

TEST(LogCalibrationPage, ShowsWhatWasFoundAndWhatItIsWorth) {
  const test::Page page = test::open_in_browser(render_report(sample_log(), "waymark calibrate odometry x"));
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(page.title, "used to the end");
  EXPECT_EQ(test::count(page.body, test::kUplot), 1U);
  for (const char* text :
       {"wheels.track_m", "as assumed", "calibrated", "calibrate odometry x", "sim:&lt;b&gt;"})
    EXPECT_THAT(page.body, HasSubstr(text));
}

TEST(LogCalibrationPage, OpensWithoutAnything) {
  const test::Page page = test::open_in_browser(render_report(calibrate::LogCalibration{}, ""));
  EXPECT_EQ(page.console, "");
}

#else

TEST(LogCalibrationPage, ShowsWhatWasFoundAndWhatItIsWorth) { GTEST_SKIP() << "no chromium on this machine"; }

#endif

}  // namespace
}  // namespace waymark
