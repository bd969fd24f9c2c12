#include "waymark/markers/black_border.hpp"

#include <gtest/gtest.h>

#include "drawn_marker.hpp"

namespace waymark::markers {
namespace {

constexpr int kBorderCells = 6;

TEST(BlackBorder, IsThereOnEveryMarker) {
  const Camera camera(test::marker_camera());
  RandomStream random(1, StreamPurpose::kWorld);
  for (int number = 0; number < 10; ++number) {
    const MarkerPose pose = test::random_marker_pose(random, 0.9);
    GreyImage image(640, 480, 120);
    test::draw_marker(image, camera, pose, 0.2, number);
    EXPECT_TRUE(has_black_border(image, test::corners_of(camera, pose, 0.2), kBorderCells)) << number;
  }
}

TEST(BlackBorder, IsNotOnABareWall) {
  const GreyImage image(640, 480, 120);
  const Camera camera(test::marker_camera());
  MarkerPose pose;
  pose.p_camera_marker = {0.0, 0.0, 2.0};
  EXPECT_FALSE(has_black_border(image, test::corners_of(camera, pose, 0.2), kBorderCells));
}

TEST(BlackBorder, IsNotWherePaperIsMissing) {
  const Camera camera(test::marker_camera());
  MarkerPose pose;
  pose.p_camera_marker = {0.0, 0.0, 1.0};
  GreyImage image(640, 480, 120);
  test::draw_marker(image, camera, pose, 0.2, 3);
  const auto corners = test::corners_of(camera, pose, 0.2);
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u)
      if (u < corners[0].x() || v < corners[0].y()) image(u, v) = 20;
  EXPECT_FALSE(has_black_border(image, corners, kBorderCells));
}

}  // namespace
}  // namespace waymark::markers
