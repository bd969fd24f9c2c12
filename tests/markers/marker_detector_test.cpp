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

/// On a wall along which the camera looks: some 8 by 25 pixels.
MarkerPose slanted_pose(RandomStream& random) {
  MarkerPose pose;
  pose.p_camera_marker = {random.uniform(-0.2, 0.2), random.uniform(-0.8, 0.8), 4.2};
  pose.R_camera_marker =
      Eigen::AngleAxisd(random.uniform(1.2, 1.25), Eigen::Vector3d::UnitY()).toRotationMatrix();
  return pose;
}

TEST(MarkerDetector, FindsMarkersOfFewPixels) {
  const auto detector = *make_marker_detector(*find_marker_dictionary("4x4_50"));
  const Camera camera(test::marker_camera());
  RandomStream random(2, StreamPurpose::kWorld);
  constexpr int kCount = 40;
  int found = 0;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  for (int i = 0; i < kCount; ++i) {
    const MarkerPose pose = slanted_pose(random);
    GreyImage image(640, 480, 120);
    test::draw_marker(image, camera, pose, 0.2, i % sim::kMarkerPatterns);
    const Corners truth = test::corners_of(camera, pose, 0.2);
    for (const Marker& marker : detector->detect(image)) {
      EXPECT_EQ(marker.id, i % sim::kMarkerPatterns);
      ++found;
      for (std::size_t k = 0; k < 4; ++k) shift += 0.25 * (marker.corners_px[k] - truth[k]);
    }
  }
  EXPECT_GT(found, kCount * 3 / 4);
  EXPECT_LT((shift / found).norm(), 0.3);
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
