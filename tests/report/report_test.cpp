#include "workbench/report/report.hpp"

#include <gtest/gtest.h>

#include "sample_report.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/report/pages.hpp"

namespace waymark {
namespace {

TEST(Report, IsOneFileWithoutAddresses) {
  const std::string html = render_report(sample_report(100));
  EXPECT_NE(html.find("Leon Sorokin"), std::string::npos);  // uPlot and its licence
  EXPECT_NE(html.find("uplot"), std::string::npos);
  EXPECT_EQ(html.find(kPageDataMark), std::string::npos);
  for (const char* load : {"http://", "https://", "src=\"", "@import", "url(", "fetch(", "XMLHttpRequest"}) {
    EXPECT_EQ(html.find(load), std::string::npos) << load;
  }
  EXPECT_LT(report_page().size(), 200'000U);
}

TEST(Report, HoldsTheDataOnce) {
  const std::string html = render_report(sample_report(100));
  const auto at = html.find("sim:circle\"");
  ASSERT_NE(at, std::string::npos);
  EXPECT_GT(at, html.find("id=\"report-data\""));
  EXPECT_LT(at, html.find("</script>", html.find("id=\"report-data\"")));
}

TEST(Report, SaysWhereItCannotBeWritten) {
  const auto written = write_report({}, "/nowhere/report.html");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("/nowhere/report.html"), std::string::npos)
      << written.error().message;
}

}  // namespace
}  // namespace waymark
