#include "waymark/markers/marker_detector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::markers {
namespace {

using testing::HasSubstr;

TEST(MarkerDetector, IsMadeForEveryDictionaryThatThisBuildCanFind) {
  for (const MarkerDictionary& each : marker_dictionaries()) {
    const auto detector = make_marker_detector(each);
    EXPECT_EQ(detector.ok(), can_detect(each.kind)) << each.name;
    if (!detector.ok()) {
      EXPECT_THAT(detector.error().message, HasSubstr("build again"));
    }
  }
}

TEST(MarkerDetector, FindsNothingWhereNothingIs) {
  const GreyImage grey(320, 240, 128);
  for (const MarkerDictionary& each : marker_dictionaries()) {
    if (!can_detect(each.kind)) continue;
    EXPECT_TRUE((*make_marker_detector(each))->detect(grey).empty()) << each.name;
  }
}

TEST(MarkerDetector, SurvivesTheSmallestImage) {
  const GreyImage tiny(16, 16, 128);
  for (const char* name : {"4x4_50", "apriltag_36h11"}) {
    const MarkerDictionary dictionary = *find_marker_dictionary(name);
    if (!can_detect(dictionary.kind)) continue;
    EXPECT_TRUE((*make_marker_detector(dictionary))->detect(tiny).empty()) << name;
  }
}

}  // namespace
}  // namespace waymark::markers
