#include "workbench/report/pages.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(Pages, HaveOnePlaceForTheirData) {
  for (const auto page : {report_page(), sweep_page(), camera_page()}) {
    const auto at = page.find(kPageDataMark);
    ASSERT_NE(at, std::string_view::npos);
    EXPECT_EQ(page.find(kPageDataMark, at + 1), std::string_view::npos);
  }
}

TEST(Pages, DataCannotEndTheirElement) {
  EXPECT_EQ(safe_in_script(R"(["</script>", "<!--"])"), R"(["\u003c/script>", "\u003c!--"])");
  EXPECT_EQ(fill_page("<p><!-- data --></p>", R"({"a": "<b>"})"), R"(<p>{"a": "\u003cb>"}</p>)");
}

}  // namespace
}  // namespace waymark
