#include "workbench/report/noise_chart.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace waymark {
namespace {

TEST(NoiseChart, ShowsBinsInTheUnitsOfItsAxes) {
  const auto chart =
      nlohmann::json::parse(noise_chart_json({"a", "b", "x", "y", 2.0, 10.0}, {{1.5, 7, 0.1, {0.2, 0.01}}}));
  EXPECT_EQ(chart["title"], "a");
  EXPECT_EQ(chart["points"].size(), 1U);
  EXPECT_EQ(chart["points"][0]["at"], 3.0);
  EXPECT_EQ(chart["points"][0]["mean"], 1.0);
  EXPECT_EQ(chart["points"][0]["sigma"], 2.0);
  EXPECT_EQ(chart["points"][0]["count"], 7);
}

TEST(NoiseChart, BearingsAreInDegrees) {
  const auto charts =
      nlohmann::json::parse(noise_charts_json({{1.0, 2, 0.0, {0.1, 0.0}}}, {{0.5, 2, 0.0, {0.1, 0.0}}}));
  ASSERT_EQ(charts.size(), 2U);
  EXPECT_EQ(charts[0]["points"][0]["at"], 1.0);
  EXPECT_NEAR(charts[1]["points"][0]["at"].get<double>(), 28.65, 0.01);
  EXPECT_NEAR(charts[1]["points"][0]["sigma"].get<double>(), 5.73, 0.01);
}

}  // namespace
}  // namespace waymark
