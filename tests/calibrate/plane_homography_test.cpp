#include "workbench/calibrate/plane_homography.hpp"

#include <gtest/gtest.h>

#include "photographed_board.hpp"

namespace waymark::calibrate {
namespace {

TEST(PlaneHomography, TakesTheBoardToItsCorners) {
  CameraOptions pinhole = test::true_camera();
  pinhole.distortion = {};
  const Board board = test::chessboard();
  for (const BoardCorners& corners : test::photograph(board, pinhole, 5, 0.0, 3)) {
    const auto H = plane_homography(board, corners);
    ASSERT_TRUE(H);
    for (const auto& [index, pixel] : corners) {
      const Eigen::Vector2d m = board.corner_m(index);
      const Eigen::Vector3d p = *H * Eigen::Vector3d(m.x(), m.y(), 1.0);
      EXPECT_NEAR((p.head<2>() / p.z() - pixel).norm(), 0.0, 1e-6);
    }
  }
}

TEST(PlaneHomography, NeedsFourCornersNotOnALine) {
  const Board board = test::chessboard();
  BoardCorners line;
  for (int i = 0; i < 9; ++i) line.push_back({i, {10.0 * i, 20.0 + i}});
  EXPECT_FALSE(plane_homography(board, line));
  EXPECT_FALSE(plane_homography(board, {{0, {0.0, 0.0}}, {1, {1.0, 0.0}}, {9, {0.0, 1.0}}}));
}

}  // namespace
}  // namespace waymark::calibrate
