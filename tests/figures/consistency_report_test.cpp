#include "workshop/figures/consistency_report.hpp"

#include <gtest/gtest.h>

#include "support/browser.hpp"

namespace waymark {
namespace {

ConsistencyReport sample_consistency() {
  study::ConsistencyOptions options;
  options.runs = 2;
  options.steps = 30;
  ConsistencyReport report{"waymark-figures consistency --runs 2", {study::compare_modes(options, 1)}};
  options.odometry_sigma_m = 0.04;
  report.comparisons.push_back(study::compare_modes(options, 1));
  return report;
}

TEST(ConsistencyReport, IsOneFileWithoutAddresses) {
  const std::string html = render_consistency_report(sample_consistency());
  EXPECT_NE(html.find("Leon Sorokin"), std::string::npos);  // uPlot and its licence
  for (const char* load : {"http://", "https://", "src=\"", "@import", "url(", "fetch(", "XMLHttpRequest"})
    EXPECT_EQ(html.find(load), std::string::npos) << load;
}

TEST(ConsistencyReport, SaysWhereItCannotBeWritten) {
  const auto written = write_consistency_report({}, "/nowhere/study.html");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("/nowhere/study.html"), std::string::npos);
}

#ifdef WAYMARK_CHROMIUM

TEST(ConsistencyPage, ShowsAllModesForEachOdometry) {
  const test::Page page = test::open_in_browser(render_consistency_report(sample_consistency()));
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(page.title, "used to the end");
  EXPECT_EQ(test::count(page.body, test::kUplot), 2U);
  for (const char* text : {"invariant", "FEJ", "standard", "99 % band", "4 cm and 1°", "--runs 2"})
    EXPECT_NE(page.body.find(text), std::string::npos) << text;
}

TEST(ConsistencyPage, OpensWithoutAnything) {
  const test::Page page = test::open_in_browser(render_consistency_report({}));
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(test::count(page.body, test::kUplot), 0U);
}

#else

TEST(ConsistencyPage, ShowsAllModesForEachOdometry) { GTEST_SKIP() << "no chromium on this machine"; }

#endif

}  // namespace
}  // namespace waymark
