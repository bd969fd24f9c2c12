#include "workbench/report/static_study_report.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "support/browser.hpp"

namespace waymark {
namespace {

using testing::HasSubstr;

calibrate::StaticStudy sample_static() {
  std::vector<calibrate::PlaceStudy> places;
  for (const double range_m : {1.0, 2.0, 3.0, 4.0}) {
    calibrate::PlaceStudy place{.place = {"a", range_m, 0.1, {}}, .scans = 10, .observations = 10};
    place.range_error_m = 0.02 * range_m + 0.01;
    place.covariance = Eigen::Matrix2d{{1e-4, 0.0}, {0.0, 1e-6}};
    places.push_back(place);
  }
  places.push_back({.place = {"far", 9.0, 0.0, {}}, .scans = 10});
  return *calibrate::study_of(places);
}

TEST(StaticStudyReport, JsonHasEveryFigure) {
  const auto json = nlohmann::json::parse(to_json(sample_static()));
  EXPECT_EQ(json["places"].size(), 5U);
  EXPECT_NEAR(json["found"]["range_scale"]["value"].get<double>(), 1.02, 1e-6);
  EXPECT_NEAR(json["found"]["range_offset_m"]["value"].get<double>(), 0.01, 1e-6);
  EXPECT_EQ(json["limits"]["max_range_m"], 4.0);
  EXPECT_FALSE(json["limits"].contains("min_range_m"));
}

TEST(StaticStudyReport, TextSaysWhatIsNotTold) {
  const std::string text = to_text(sample_static());
  EXPECT_THAT(text, HasSubstr("range scale"));
  EXPECT_THAT(text, HasSubstr("note: the minimum range is not observable"));
}

#ifdef WAYMARK_CHROMIUM

TEST(StaticStudyPage, ShowsErrorsByRangeAndBearing) {
  const test::Page page =
      test::open_in_browser(render_report(sample_static(), "waymark calibrate sensor --places p"));
  EXPECT_EQ(page.console, "");
  EXPECT_EQ(test::count(page.body, test::kUplot), 2U);
  for (const char* text : {"range scale", "calibrate sensor --places p", "minimum range"})
    EXPECT_THAT(page.body, HasSubstr(text));
}

#endif

}  // namespace
}  // namespace waymark
