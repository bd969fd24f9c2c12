#include "waymark/markers/quad_finder.hpp"

#include <gtest/gtest.h>

#include "drawn_marker.hpp"

namespace waymark::markers {
namespace {

bool is_found(const std::vector<Corners>& quads, const Corners& truth) {
  return std::ranges::any_of(quads, [&](const Corners& quad) {
    return std::ranges::all_of(truth, [&](const Eigen::Vector2d& corner) {
      return std::ranges::any_of(quad, [&](const auto& each) { return (each - corner).norm() < 1.0; });
    });
  });
}

TEST(QuadFinder, FindsTheOutlineOfEveryMarker) {
  const Camera camera(test::marker_camera());
  RandomStream random(1, StreamPurpose::kWorld);
  QuadFinder finder;
  for (int number = 0; number < 20; ++number) {
    const MarkerPose pose = test::random_marker_pose(random, 1.0);
    GreyImage image(640, 480, 120);
    test::draw_marker(image, camera, pose, 0.2, number);
    EXPECT_TRUE(is_found(finder.find(image), test::corners_of(camera, pose, 0.2))) << number;
  }
}

TEST(QuadFinder, FindsABlurredOne) {
  const Camera camera(test::marker_camera());
  MarkerPose pose;
  pose.p_camera_marker = {0.0, 0.0, 1.0};
  GreyImage sharp(640, 480, 120);
  test::draw_marker(sharp, camera, pose, 0.2, 3);
  GreyImage blurred(640, 480, 120);
  constexpr int kHalf_px = 7;  // as while turning
  for (int v = 0; v < 480; ++v)
    for (int u = kHalf_px; u < 640 - kHalf_px; ++u) {
      int sum = 0;
      for (int i = -kHalf_px; i <= kHalf_px; ++i) sum += sharp(u + i, v);
      blurred(u, v) = static_cast<std::uint8_t>(sum / (2 * kHalf_px + 1));
    }
  EXPECT_FALSE(QuadFinder().find(blurred).empty());
}

TEST(QuadFinder, LeavesOutWhatTheEdgeCutsOff) {
  GreyImage image(120, 100, 220);
  for (int v = 30; v < 70; ++v)
    for (int u = 0; u < 40; ++u) image(u, v) = 20;
  EXPECT_TRUE(QuadFinder().find(image).empty());
}

TEST(QuadFinder, FindsNothingOnABareWall) { EXPECT_TRUE(QuadFinder().find(GreyImage(64, 48, 90)).empty()); }

}  // namespace
}  // namespace waymark::markers
