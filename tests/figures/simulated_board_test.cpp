#include "workshop/figures/simulated_board.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace waymark::calibrate::simulated {
namespace {

std::vector<BoardCorners> photograph_with(const Poses& poses, const Flaws& flaws, std::uint64_t seed = 1) {
  RandomStream random(seed, StreamPurpose::kSimulation);
  return photograph(chessboard(), true_camera(), 10, poses, flaws, random);
}

/// What remains of the corners, in pixels, when the true camera is at each view's best pose.
double rms_px_with(const Flaws& flaws) {
  std::vector<FittedView> fits;
  for (const BoardCorners& corners : photograph_with({}, flaws))
    fits.push_back(*fit_pose(chessboard(), corners, true_camera()));
  return rms_px(fits);
}

TEST(SimulatedBoard, WithoutFlawsIsWhatTheCameraSees) { EXPECT_LT(rms_px_with({.noise_px = 0.0}), 1e-6); }

TEST(SimulatedBoard, EveryFlawLeavesErrors) {
  for (const Flaws& flaws :
       {Flaws{.noise_px = 0.2}, Flaws{.noise_px = 0.0, .bend_m = {0.001, 0.0, 0.0}},
        Flaws{.noise_px = 0.0, .flex_m = 0.001}, Flaws{.noise_px = 0.0, .rolling_px = 2.0},
        Flaws{.noise_px = 0.0, .fisheye = true}})
    EXPECT_GT(rms_px_with(flaws), 0.1);
  EXPECT_GT(rms_px_with({.noise_px = 0.2, .uneven = 1.0}), 1.2 * rms_px_with({.noise_px = 0.2}));
}

TEST(SimulatedBoard, RisesByItsBendAtItsEnds) {
  const Eigen::Isometry3d T(Eigen::Translation3d(-0.1, -0.0625, 0.5));
  const auto bent = project(chessboard(), true_camera(), T, {.bend_m = {0.01, 0.0, 0.0}});
  const Eigen::Vector3d risen = T * Eigen::Vector3d(0.0, 0.0, 0.01);
  ASSERT_EQ(std::ssize(bent), chessboard().size());
  EXPECT_TRUE(bent[0].pixel.isApprox(Camera(true_camera()).project(risen)->pixel));
}

TEST(SimulatedBoard, OfAFisheyeIsSeenAtItsAngle) {
  CameraOptions camera = true_camera();
  camera.distortion = {};
  const Board board{.corners = {2, 2}, .square_m = 0.3};
  const Eigen::Isometry3d T(Eigen::Translation3d(0.0, 0.0, 1.0));
  const auto seen = project(board, camera, T, {.fisheye = true});
  ASSERT_EQ(seen.size(), 4U);
  EXPECT_NEAR(seen[1].pixel.x(), camera.cu_px + camera.fu_px * std::atan(0.3), 1e-9);
}

TEST(SimulatedBoard, LiesInThePartOfTheImageThatIsAskedFor) {
  for (const BoardCorners& corners : photograph_with({.farthest_m = 0.9, .part = 0.6}, {.noise_px = 0.0}))
    EXPECT_TRUE(std::ranges::all_of(corners, [](const BoardCorner& corner) {
      return corner.pixel.x() < 0.6 * 640.0 && corner.pixel.y() < 0.6 * 480.0;
    }));
}

TEST(SimulatedBoard, IsTheSameForASeed) {
  const auto first = photograph_with({}, {.flex_m = 0.001}, 2),
             again = photograph_with({}, {.flex_m = 0.001}, 2);
  EXPECT_EQ(first[9][53].pixel, again[9][53].pixel);
  EXPECT_NE(first[9][53].pixel, photograph_with({}, {.flex_m = 0.001}, 3)[9][53].pixel);
}

}  // namespace
}  // namespace waymark::calibrate::simulated
