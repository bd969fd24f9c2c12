#include "workbench/report/sweep_report.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/browser.hpp"

namespace waymark {
namespace {

study::SweepGroup group(std::vector<std::string> values, double scale) {
  study::SweepGroup made{.values = std::move(values), .runs = 5};
  for (std::size_t i = 0; i < made.median.size(); ++i) {
    made.median[i] = scale * (1.0 + static_cast<double>(i));
    made.low[i] = 0.5 * made.median[i];
    made.high[i] = 2.0 * made.median[i];
  }
  return made;
}

/// Two observation modes of FastSLAM over N, and the EKF.
SweepReport sample_sweep() {
  SweepReport report{"sim:study", "waymark sweep", 35, {{"filter", "observe", "fastslam.particles"}, {}}};
  for (const char* observe : {"range-bearing", "bearing"})
    for (const char* particles : {"10", "150", "1000"})
      report.summary.groups.push_back(group({"fastslam", observe, particles}, 0.1));
  report.summary.groups.push_back(group({"ekf", "range-bearing", ""}, 0.05));
  return report;
}

TEST(SweepReport, IsOneFileWithoutAddresses) {
  const std::string html = render_sweep_report(sample_sweep());
  EXPECT_NE(html.find("Leon Sorokin"), std::string::npos);  // uPlot and its licence
  for (const char* load : {"http://", "https://", "src=\"", "@import", "url(", "fetch(", "XMLHttpRequest"})
    EXPECT_EQ(html.find(load), std::string::npos) << load;
}

TEST(SweepReport, JsonHasQuartilesAndLeavesOutWhatIsNotKnown) {
  SweepReport report = sample_sweep();
  const std::size_t nees = study::figure_index("nees_mean");
  report.summary.groups[0].median[nees] = std::nan("");
  const auto json = nlohmann::json::parse(sweep_json_text(report.summary));
  const auto& first = json["groups"][0];
  EXPECT_EQ(first["axes"]["fastslam.particles"], "10");
  EXPECT_EQ(first["runs"], 5);
  EXPECT_DOUBLE_EQ(first["figures"]["position_rmse_m"][0], 0.05);
  EXPECT_DOUBLE_EQ(first["figures"]["position_rmse_m"][1], 0.1);
  EXPECT_FALSE(first["figures"].contains("nees_mean"));
  EXPECT_FALSE(json["groups"][6]["axes"].contains("fastslam.particles"));
}

TEST(SweepReport, SaysWhereItCannotBeWritten) {
  const auto written = write_sweep_report({}, "/nowhere/sweep.html");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("/nowhere/sweep.html"), std::string::npos);
}

#ifdef WAYMARK_CHROMIUM

TEST(SweepPage, DrawsTheThreeFiguresAndTheComparison) {
  const test::Page page = test::open_in_browser(render_sweep_report(sample_sweep()));
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(page.title, "used to the end");
  EXPECT_EQ(test::count(page.body, test::kUplot), 5U);  // path, landmarks; time; mixture, mean covariance
  for (const char* text : {"fastslam, bearing", "Beside the original FastSLAM report", "All settings"})
    EXPECT_NE(page.body.find(text), std::string::npos) << text;
}

TEST(SweepPage, WithoutAnAxisOfNumbersHasTheTableOnly) {
  SweepReport report{"somewhere", "", 5, {{"filter"}, {group({"ekf"}, 1.0), group({"fastslam"}, 2.0)}}};
  const test::Page page = test::open_in_browser(render_sweep_report(report));
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(test::count(page.body, test::kUplot), 0U);
  EXPECT_NE(page.body.find("All settings"), std::string::npos);
  EXPECT_EQ(page.body.find("original FastSLAM report"), std::string::npos);
}

#else

TEST(SweepPage, DrawsTheThreeFiguresAndTheComparison) { GTEST_SKIP() << "no chromium on this machine"; }

#endif

}  // namespace
}  // namespace waymark
