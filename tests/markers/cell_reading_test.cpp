#include "waymark/markers/cell_reading.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "waymark/markers/aruco_codes.hpp"

#include "drawn_marker.hpp"

namespace waymark::markers {
namespace {

constexpr int kBits = 4;
const MarkerDictionary kDictionary = *find_marker_dictionary("4x4_50");

struct Drawn {
  GreyImage image;
  Corners corners;
};

Drawn draw(const MarkerPose& pose, int number) {
  const Camera camera(test::marker_camera());
  Drawn drawn{GreyImage(640, 480, 120), test::corners_of(camera, pose, 0.2)};
  test::draw_marker(drawn.image, camera, pose, 0.2, number);
  return drawn;
}

TEST(CellReading, GivesTheBitsOfTheMarker) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (int number = 0; number < sim::kMarkerPatterns; ++number) {
    const Drawn drawn = draw(test::random_marker_pose(random, 0.9), number);
    const auto cells = read_cells(drawn.image, drawn.corners, kBits);
    ASSERT_TRUE(cells) << number;
    EXPECT_EQ(cells->bits, aruco_code(kDictionary, number));
    EXPECT_EQ(cells->wrong_border, 0);
    EXPECT_LE(cells->divided, 3);
  }
}

/// The light falls off by two thirds across the marker.
TEST(CellReading, FollowsTheLight) {
  MarkerPose pose;
  pose.p_camera_marker = {0.0, 0.0, 1.0};
  Drawn drawn = draw(pose, 7);
  const double left = drawn.corners[0].x(), width = drawn.corners[1].x() - left;
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u) {
      const double light = 1.0 - 0.66 * std::clamp((u - left) / width, -0.3, 1.3);
      drawn.image(u, v) = static_cast<std::uint8_t>(std::lround(light * drawn.image(u, v)));
    }
  const auto cells = read_cells(drawn.image, drawn.corners, kBits);
  ASSERT_TRUE(cells);
  EXPECT_EQ(cells->bits, aruco_code(kDictionary, 7));
}

TEST(CellReading, CountsWhatIsHiddenOfTheBorder) {
  MarkerPose pose;
  pose.p_camera_marker = {0.0, 0.0, 1.0};
  Drawn drawn = draw(pose, 7);
  const auto& corner = drawn.corners[0];
  for (int v = 0; v < 19; ++v)  // cells are of 18 pixels
    for (int u = 0; u < 40; ++u)
      drawn.image(static_cast<int>(corner.x()) + u, static_cast<int>(corner.y()) + v) = 210;
  const auto cells = read_cells(drawn.image, drawn.corners, kBits);
  ASSERT_TRUE(cells);
  EXPECT_EQ(cells->wrong_border, 2);
}

/// Six cells read as five divide many of them.
TEST(CellReading, CountsCellsOfTwoColours) {
  MarkerPose pose;
  pose.p_camera_marker = {0.0, 0.0, 1.0};
  const Drawn drawn = draw(pose, 7);
  const auto cells = read_cells(drawn.image, drawn.corners, kBits + 1);
  ASSERT_TRUE(cells);
  EXPECT_GT(cells->divided, 8);
}

TEST(CellReading, IsNoneOnABareWallNorOfADegenerateQuad) {
  const GreyImage wall(64, 48, 120);
  EXPECT_FALSE(read_cells(wall, {{{10, 10}, {30, 10}, {30, 30}, {10, 30}}}, kBits));
  EXPECT_FALSE(read_cells(wall, {{{10, 10}, {20, 10}, {30, 10}, {40, 10}}}, kBits));
}

}  // namespace
}  // namespace waymark::markers
