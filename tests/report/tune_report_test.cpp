#include "workbench/report/tune_report.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/browser.hpp"

#include "workbench/study/sweep_summary.hpp"

namespace waymark {
namespace {

study::TunedKey key(std::string name, double after) {
  study::TunedKey made{
      .name = std::move(name), .before = 0.3, .after = after, .interval = {{0.9 * after, 1.1 * after}}};
  for (const double factor : {0.5, 0.8, 0.9, 1.0, 1.1, 1.2, 2.0})
    made.slice.emplace_back(factor * after, -100.0 * (factor - 1.0) * (factor - 1.0));
  return made;
}

study::TuneResult sample_tune() {
  study::TuneResult result{.keys = {key("sensor.range_sigma_m", 0.1), key("sensor.bearing_sigma_deg", 1.0)},
                           .idle_keys = {"motion.turn_var_rad2_per_m"},
                           .observations = 1000,
                           .before = 1.0,
                           .after = 2.0,
                           .held_out = {{"0 to 25 % of the observations", 1.0, 1.9}, {"all", 1.0, 1.8}},
                           .logs = {{"LOG", 1.0, 2.0}},
                           .runs = 77};
  result.keys[1].open_low = true;
  auto& log = result.logs.front();
  log.figures_before.fill(std::nan(""));
  log.figures_after.fill(std::nan(""));
  log.figures_before[study::figure_index("nis_per_dof")] = 0.5;
  log.figures_after[study::figure_index("nis_per_dof")] = 1.01;
  return result;
}

TEST(TuneReport, JsonHasWhatMovedAndLeavesOutWhatIsNotKnown) {
  const auto json = nlohmann::json::parse(tune_json_text(sample_tune()));
  EXPECT_EQ(json["by"], "likelihood");
  EXPECT_EQ(json["keys"][0]["after"], 0.1);
  EXPECT_EQ(json["keys"][0]["high"], 0.11);
  EXPECT_TRUE(json["keys"][1]["low"].is_null());
  EXPECT_EQ(json["held_out"][1]["after"], 1.8);
  EXPECT_EQ(json["logs"][0]["after"]["nis_per_dof"], 1.01);
  EXPECT_FALSE(json["logs"][0]["after"].contains("position_rmse_m"));
}

TEST(TuneReport, IsOneFileWithoutAddresses) {
  const std::string html = render_tune_report(sample_tune(), "waymark tune LOG");
  for (const char* load : {"http://", "https://", "src=\"", "@import", "url(", "fetch(", "XMLHttpRequest"})
    EXPECT_EQ(html.find(load), std::string::npos) << load;
}

TEST(TuneReport, SaysWhereItCannotBeWritten) {
  const auto written = write_tune_report(sample_tune(), "", "/nowhere/report.html");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("/nowhere/report.html"), std::string::npos);
}

#ifdef WAYMARK_CHROMIUM

TEST(TunePage, DrawsAProfilePerKeyAndTheTables) {
  const test::Page page = test::open_in_browser(render_tune_report(sample_tune(), "waymark tune LOG"));
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(page.title, "used to the end");
  EXPECT_EQ(test::count(page.body, test::kUplot), 2U);
  for (const char* text : {"What moved", "below 1.1", "Where it was left out of the fit",
                           "motion.turn_var_rad2_per_m", "NIS per dof", "waymark tune LOG"})
    EXPECT_NE(page.body.find(text), std::string::npos) << text;
  EXPECT_EQ(page.body.find("Path, from start"), std::string::npos);  // not known
  EXPECT_EQ(page.body.find("[object"), std::string::npos);
}

TEST(TunePage, OfATuningThatWasStoppedHasTheKeysOnly) {
  study::TuneResult stopped = sample_tune();
  stopped.stopped = true;
  stopped.held_out.clear();
  stopped.logs.clear();
  for (auto& each : stopped.keys) each.interval.reset(), each.slice.clear();
  const test::Page page = test::open_in_browser(render_tune_report(stopped, ""));
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(test::count(page.body, test::kUplot), 0U);
  EXPECT_NE(page.body.find("Stopped before the end"), std::string::npos);
}

#else

TEST(TunePage, DrawsAProfilePerKeyAndTheTables) { GTEST_SKIP() << "no chromium on this machine"; }

#endif

}  // namespace
}  // namespace waymark
