#include "workbench/study/sweep_summary.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "study_support.hpp"

namespace waymark::study {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

SweepRow row(const std::string& seed, const std::string& filter, double path_rmse_m,
             double odometry_rmse_m = 1.0) {
  SweepRow made{{seed, filter}, {}, {}};
  made.figures.fill(std::nan(""));
  made.figures[figure_index("position_rmse_m")] = path_rmse_m;
  made.figures[figure_index("odometry_position_rmse_m")] = odometry_rmse_m;
  return made;
}

const SweepPlan kPlan = test::quick_plan({{"seed", {"1", "2", "3", "4"}}, {"filter", {"ekf", "fastslam"}}});

TEST(SweepSummary, QuartilesOverTheSeedsOfEverySetting) {
  std::vector<SweepRow> rows;
  for (const auto& [seed, rmse_m] : {std::pair("1", 0.4), {"2", 0.1}, {"3", 0.3}, {"4", 0.2}}) {
    rows.push_back(row(seed, "ekf", rmse_m));
    rows.push_back(row(seed, "fastslam", 2.0 * rmse_m));
  }
  const auto summary = summarise(kPlan, rows);
  EXPECT_THAT(summary.axes, ElementsAre("filter"));
  ASSERT_EQ(summary.groups.size(), 2U);
  const auto& ekf = summary.groups[0];
  const std::size_t rmse = figure_index("position_rmse_m");
  EXPECT_THAT(ekf.values, ElementsAre("ekf"));
  EXPECT_EQ(ekf.runs, 4U);
  EXPECT_NEAR(ekf.median[rmse], 0.25, 1e-12);
  EXPECT_NEAR(ekf.low[rmse], 0.175, 1e-12);
  EXPECT_NEAR(ekf.high[rmse], 0.325, 1e-12);
  EXPECT_NEAR(summary.groups[1].median[rmse], 0.5, 1e-12);
  EXPECT_TRUE(std::isnan(ekf.median[figure_index("nees_mean")]));
}

TEST(SweepSummary, CountsDivergedAndFailedRuns) {
  SweepRow failed = row("3", "ekf", std::nan(""), std::nan(""));
  failed.error = "no luck";
  const auto summary = summarise(kPlan, std::vector{row("1", "ekf", 2.0), row("2", "ekf", 0.5), failed});
  ASSERT_EQ(summary.groups.size(), 1U);
  EXPECT_EQ(summary.groups[0].runs, 2U);
  EXPECT_EQ(summary.groups[0].failed, 1U);
  EXPECT_EQ(summary.groups[0].diverged, 1U);
}

TEST(SweepSummary, TextHasARowPerSetting) {
  const auto text = to_text(summarise(kPlan, std::vector{row("1", "ekf", 0.25), row("1", "fastslam", 0.5)}));
  EXPECT_THAT(text, HasSubstr("filter"));
  EXPECT_THAT(text, testing::ContainsRegex("ekf +1 +0 +0.25 +-"));
  EXPECT_EQ(std::ranges::count(text, '\n'), 3);
}

}  // namespace
}  // namespace waymark::study
