#include "workbench/report/report_json.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sample_report.hpp"

namespace waymark {
namespace {

using nlohmann::json;

TEST(ReportJson, CannotEndTheScriptElement) {
  ReportData data;
  data.title = "</script><script>alert(1)</script><!--";
  const std::string text = report_json(data);
  EXPECT_EQ(text.find('<'), std::string::npos);
  EXPECT_EQ(json::parse(text).at("title"), data.title);
}

TEST(ReportJson, WritesNullForWhatIsNotFinite) {
  ReportData data;
  data.truth = {
      {0.0, 1.0, 2.0}, {1.0, std::nan(""), 3.0}, {0.0, 0.0, std::numeric_limits<double>::infinity()}, {}};
  const json truth = json::parse(report_json(data)).at("truth");
  EXPECT_EQ(truth.at("x"), json::parse("[1.0, null, 3.0]"));
  EXPECT_EQ(truth.at("y"), json::parse("[0.0, 0.0, null]"));
  EXPECT_FALSE(truth.contains("theta"));
}

TEST(ReportJson, RoundsToSixDigitsButKeepsStamps) {
  ReportData data;
  data.truth = {{1288971842.06161}, {0.123456789}, {-98765.4321}, {}};
  const json truth = json::parse(report_json(data)).at("truth");
  EXPECT_EQ(truth.at("t").dump(), "[1288971842.0616]");
  EXPECT_EQ(truth.at("x").dump(), "[0.123457]");
  EXPECT_EQ(truth.at("y").dump(), "[-98765.4]");
}

TEST(ReportJson, ThinsLongSeriesAndKeepsTheirPeaks) {
  auto data = sample_report(60'000);
  data.runs[0].steps.us[30'001] = 12'345.0;
  const std::string text = report_json(data);
  EXPECT_LT(text.size(), 3'000'000U);
  const json run = json::parse(text).at("runs").at(0);
  for (const char* series : {"path", "errors", "innovations", "steps"}) {
    const json& t = run.at(series).at("t");
    EXPECT_LE(t.size(), kMaxReportRows) << series;
    EXPECT_EQ(t.front(), 0.0) << series;
    EXPECT_DOUBLE_EQ(t.back().get<double>(), 5999.9) << series;
    for (const auto& [name, column] : run.at(series).items()) {
      if (!column.is_array()) continue;
      EXPECT_EQ(column.size(), t.size()) << series << "." << name;
    }
  }
  const auto us = run.at("steps").at("us").get<std::vector<double>>();
  EXPECT_EQ(*std::max_element(us.begin(), us.end()), 12'345.0);
}

TEST(ReportJson, SaysWhatBecameOfEachLook) {
  const json image_strip = json::parse(report_json(sample_report(10))).at("runs").at(0).at("image_strip");
  ASSERT_EQ(image_strip.size(), 2U);
  std::vector<std::string> results;
  for (const json& look : image_strip.at(1).at("search_records")) results.push_back(look.at("result"));
  EXPECT_EQ(results, (std::vector<std::string>{"not tried", "found", "rejected", "new", "not tried"}));
  EXPECT_EQ(image_strip.at(1).at("search_records").at(1).at("u"), 10.25);
  EXPECT_EQ(image_strip.at(1).at("png").get<std::string>().substr(0, 11),
            "iVBORw0KGgo");  // how PNG files begin
}

TEST(ReportJson, CountsAllInnovationsInTheHistogram) {
  const json innovations = json::parse(report_json(sample_report(60'000))).at("runs").at(0).at("innovations");
  const json& histogram = innovations.at("histogram");
  for (std::size_t i = 0; i < histogram.at("density").size(); ++i) {
    EXPECT_NEAR(histogram.at("density")[i].get<double>(), histogram.at("expected")[i].get<double>(), 1e-3);
  }
}

TEST(ReportJson, HasASmoothedPathWhereThereIsOne) {
  ReportData data;
  data.runs.resize(2);
  data.runs[1].smoothed = {{0.0, 1.0}, {2.0, 3.0}, {4.0, 5.0}, {0.0, 0.0}};
  const auto report = nlohmann::ordered_json::parse(report_json(data));
  EXPECT_FALSE(report.at("runs").at(0).contains("smoothed"));
  EXPECT_EQ(report.at("runs").at(1).at("smoothed").at("y").dump(), "[4.0,5.0]");
}

TEST(ReportJson, KeepsMetricsInTheirOrder) {
  ReportData data;
  data.runs.resize(2);
  data.runs[0].metrics_json = R"({"z": 1, "a": {"y": 2, "b": 3}})";
  data.runs[1].metrics_json = "not json";
  const auto report = nlohmann::ordered_json::parse(report_json(data));
  EXPECT_EQ(report.at("runs").at(0).at("metrics").dump(), R"({"z":1,"a":{"y":2,"b":3}})");
  EXPECT_EQ(report.at("runs").at(1).at("metrics").dump(), "{}");
}

TEST(ReportJson, TakesTextThatIsNotUtf8AndColumnsThatDoNotFit) {
  ReportData data;
  data.title = "caf\xe9";
  data.runs.resize(1);
  data.runs[0].errors.t_s = {0.0, 1.0};
  data.runs[0].errors.x_m = {0.5};
  data.runs[0].innovations.nis = {1.0};
  const json report = json::parse(report_json(data));
  EXPECT_TRUE(report.at("runs").at(0).at("errors").at("x_m").empty());
}

}  // namespace
}  // namespace waymark
