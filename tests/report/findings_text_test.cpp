#include "workbench/report/findings_text.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace waymark {
namespace {

using testing::HasSubstr;

const std::vector<calibrate::CalibrationFinding> kFindings{{{"wheels.track_m", 0.33, 0.001}, 0.3},
                                                           {{"sensor.x_m", 0.1, 0.5, true}, 0.1}};

TEST(FindingsText, HasARowPerFindingAndSaysWhatIsOnlyAssumed) {
  const std::string text = findings_text(kFindings, 4, "a log");
  EXPECT_THAT(text, HasSubstr("4 runs over a log"));
  EXPECT_THAT(text, HasSubstr("0.30000      0.33000 +- 0.00100\n"));
  EXPECT_THAT(text, HasSubstr("0.10000 +- 0.50000   (prior: not observable)\n"));
}

TEST(FindingsJson, IsByKey) {
  const auto json = nlohmann::json::parse(findings_json(kFindings));
  EXPECT_EQ(json["wheels.track_m"]["before"], 0.3);
  EXPECT_TRUE(json["wheels.track_m"]["told"]);
  EXPECT_FALSE(json["sensor.x_m"]["told"]);
  EXPECT_EQ(findings_json({}), "{}");
}

}  // namespace
}  // namespace waymark
