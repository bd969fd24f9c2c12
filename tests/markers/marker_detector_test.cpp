#include "waymark/markers/marker_detector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drawn_marker.hpp"

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

/// The simulator's own table of patterns is that of the dictionary.
TEST(MarkerDetector, ReadsEveryMarkerThatTheSimulatorPrints) {
  if (!can_detect(MarkerKind::kAruco)) GTEST_SKIP() << "built without OpenCV";
  const auto detector = *make_marker_detector(*find_marker_dictionary("4x4_50"));
  const Camera camera(test::marker_camera());
  RandomStream random(1, StreamPurpose::kWorld);
  for (int number = 0; number < sim::kMarkerPatterns; ++number) {
    const MarkerPose pose = test::random_marker_pose(random, 0.6);
    GreyImage image(640, 480, 120);
    test::draw_marker(image, camera, pose, 0.2, number);
    const auto found = detector->detect(image);
    ASSERT_EQ(found.size(), 1U) << number;
    EXPECT_EQ(found[0].id, number);
    const Corners truth = test::corners_of(camera, pose, 0.2);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((found[0].corners_px[i] - truth[i]).norm(), 2.0) << number;
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
