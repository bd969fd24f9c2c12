// The page in a browser: it draws, it answers, and it reports no error on the console.

#include <gtest/gtest.h>

#include "support/browser.hpp"

#include "sample_report.hpp"
#include "workbench/report/pages.hpp"

namespace waymark {
namespace {

#ifdef WAYMARK_CHROMIUM

using test::count;
using test::kUplot;

test::Page open_in_browser(const ReportData& data) { return test::open_in_browser(render_report(data)); }

TEST(ReportPage, DrawsEverythingAndAnswers) {
  const test::Page page = open_in_browser(sample_report(900));
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(page.title, "used to the end");
  EXPECT_EQ(count(page.body, kUplot), 8U);  // position; x, y, heading, NEES; innovations, histogram; steps
  EXPECT_EQ(count(page.body, "class=\"map-frame\""), 1U);
  EXPECT_EQ(count(page.body, "<ellipse"), 5U);  // of the one image that is shown
  for (const char* text :
       {"Runs compared", "Function blocks", "position_rmse_m", "3 observations came before", "Run it again",
        "class=\"verdict warn\"", "lost and found again 2 times"}) {
    EXPECT_NE(page.body.find(text), std::string::npos) << text;
  }
}

TEST(ReportPage, LeavesOutWhatARunDoesNotHave) {
  ReportData data = sample_report(300);
  data.truth = {};
  data.truth_landmarks.clear();
  data.dead_reckoning = {};
  data.runs.resize(1);
  data.runs[0].errors = {};
  data.runs[0].alignment.reset();
  const test::Page page = open_in_browser(data);
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(count(page.body, kUplot), 3U);
  EXPECT_EQ(page.body.find("Errors over time"), std::string::npos);
  EXPECT_EQ(page.body.find("Runs compared"), std::string::npos);
}

TEST(ReportPage, OpensWithoutAnything) {
  ReportData data;
  data.runs.resize(1);
  const test::Page page = open_in_browser(data);
  EXPECT_EQ(page.console, "");
  EXPECT_NE(page.body.find("nothing to show"), std::string::npos);
  EXPECT_EQ(count(page.body, kUplot), 0U);
}

#else

TEST(ReportPage, DrawsEverythingAndAnswers) { GTEST_SKIP() << "no chromium on this machine"; }

#endif

}  // namespace
}  // namespace waymark
