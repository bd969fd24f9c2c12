#include "workbench/report/moving_study_report.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "support/browser.hpp"

namespace waymark {
namespace {

using testing::HasSubstr;

calibrate::MovingStudy sample_moving() {
  calibrate::MovingStudy study;
  study.input = "sim:<b>";
  study.runs = 3;
  study.settled = true;
  study.findings = {{{"sensor.range_sigma_ratio", 0.01, 0.002}, 0.0},
                    {{"sensor.bearing_sigma_deg", 1.5, 0.02}, 1.0},
                    {{"sensor.delay_s", 0.0, 0.1, true}, 0.0}};
  for (int i = 1; i <= 5; ++i) {
    study.noise.ranges.push_back({1.0 * i, 100, 0.001 * i, {0.05 + 0.01 * i, 0.001}});
    study.noise.bearings.push_back({0.1 * (i - 3), 100, 0.001, {0.026, 0.001}});
  }
  study.noise.outliers = 4;
  study.odometry_noise[2] = {2.0, 0.1};
  study.notes = {"not converged"};
  return study;
}

TEST(MovingStudyReport, JsonHasEveryFigure) {
  const auto json = nlohmann::json::parse(to_json(sample_moving()));
  EXPECT_EQ(json["found"]["sensor.range_sigma_ratio"]["value"], 0.01);
  EXPECT_EQ(json["found"]["sensor.bearing_sigma_deg"]["sigma"], 0.02);
  EXPECT_FALSE(json["found"]["sensor.delay_s"]["told"]);
  EXPECT_EQ(json["ranges"].size(), 5U);
  EXPECT_EQ(json["odometry_noise"][2]["value"], 2.0);
  EXPECT_EQ(json["outliers"], 4);
}

TEST(MovingStudyReport, TextHasFindingsTablesAndNotes) {
  const std::string text = to_text(sample_moving());
  for (const char* part : {"3 runs over sim:<b>", "sensor.bearing_sigma_deg", "(prior: not observable)",
                           "range, m", "bearing, deg", "note: not converged"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST(MovingStudyReport, SaysWhereItCannotBeWritten) {
  const auto written = write_results(sample_moving(), "/nowhere", "");
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("/nowhere/calibration.yaml"));
}

#ifdef WAYMARK_CHROMIUM

TEST(SensorPage, ShowsWhatWasFoundAndHowErrorsLie) {
  const test::Page page = test::open_in_browser(render_report(sample_moving(), "waymark calibrate sensor x"));
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(page.title, "used to the end");
  EXPECT_EQ(test::count(page.body, test::kUplot), 2U);
  for (const char* text :
       {"sensor.range_sigma_ratio", "not converged", "calibrate sensor x", "sim:&lt;b&gt;"})
    EXPECT_THAT(page.body, HasSubstr(text));
}

TEST(SensorPage, OpensWithoutAnything) {
  const test::Page page = test::open_in_browser(render_report(calibrate::MovingStudy{}, ""));
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(test::count(page.body, test::kUplot), 0U);
}

#endif

}  // namespace
}  // namespace waymark
