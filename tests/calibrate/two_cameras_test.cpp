#include "workbench/calibrate/two_cameras.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "photographed_board.hpp"
#include "workbench/calibrate/camera_calibration.hpp"

namespace waymark::calibrate {
namespace {

using test::chessboard;
using test::named;
using test::photograph;
using test::true_camera;
using Places = std::vector<std::size_t>;

constexpr double kNoise_px = 0.12;

/// Another one of the same make.
CameraOptions other_camera() {
  CameraOptions camera = true_camera();
  camera.fu_px *= 1.03;
  camera.fv_px *= 1.03;
  camera.cu_px -= 30.0;
  camera.cv_px += 20.0;
  return camera;
}

CameraOptions zoomed(double by) {
  CameraOptions camera = true_camera();
  camera.fu_px *= by;
  camera.fv_px *= by;
  return camera;
}

/// A view of the second after each of the first, as long as there are any.
std::vector<BoardView> alternating(const std::vector<BoardCorners>& first,
                                   const std::vector<BoardCorners>& second) {
  std::vector<BoardCorners> corners;
  for (std::size_t i = 0; i < first.size(); ++i) {
    corners.push_back(first[i]);
    if (i < second.size()) corners.push_back(second[i]);
  }
  return named(corners);
}

/// Of a board that is curved and twisted by `bend_m` at its ends, other than its model.
std::vector<BoardCorners> photograph_bent(double bend_m, std::size_t count, std::uint64_t seed) {
  RandomStream random(seed, StreamPurpose::kSimulation);
  return simulated::photograph(chessboard(), true_camera(), count, {},
                               {.noise_px = kNoise_px, .bend_m = {bend_m, bend_m, 0.0}}, random);
}

TEST(TwoCameras, OfTheSameMakeAreToldApartViewByView) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const auto found = find_two_cameras(
        chessboard(), alternating(photograph(chessboard(), true_camera(), 13, kNoise_px, seed),
                                  photograph(chessboard(), other_camera(), 13, kNoise_px, 100 + seed)));
    ASSERT_TRUE(found) << seed;
    ASSERT_EQ(found->groups[0].views.size() + found->groups[1].views.size(), 26U);
    // One view may say so little of the camera that noise decides where it goes.
    const auto astray =
        std::ranges::count_if(found->groups[0].views, [](std::size_t i) { return i % 2 == 1; }) +
        std::ranges::count_if(found->groups[1].views, [](std::size_t i) { return i % 2 == 0; });
    EXPECT_LE(astray, 1) << seed;
    for (const auto& group : found->groups) EXPECT_NEAR(group.rms_px, kNoise_px * std::sqrt(2.0), 0.02);
    EXPECT_GT(found->together_px, 1.1 * kNoise_px * std::sqrt(2.0));
  }
}

TEST(TwoCameras, AreAlsoOneThatZoomed) {
  auto corners = photograph(chessboard(), true_camera(), 7, kNoise_px, 1);
  for (auto& view : photograph(chessboard(), zoomed(1.5), 9, kNoise_px, 2))
    corners.push_back(std::move(view));
  const auto found = find_two_cameras(chessboard(), named(corners));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->groups[0].views, Places({0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(found->groups[1].views.size(), 9U);
}

TEST(TwoCameras, AreFoundWhereTheFewAreDropped) {
  const auto result =
      calibrate_camera(chessboard(), alternating(photograph(chessboard(), true_camera(), 16, kNoise_px, 3),
                                                 photograph(chessboard(), zoomed(1.3), 4, kNoise_px, 4)));
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_GT(std::ranges::count(result->views, Fate::kOutlier, &BoardView::fate), 0);
  ASSERT_TRUE(result->two_cameras);
  EXPECT_EQ(result->two_cameras->groups[1].views, Places({1, 3, 5, 7}));
  EXPECT_NE(result->weaknesses[0].what.find(" dropped)"), std::string::npos) << result->weaknesses[0].what;
}

TEST(TwoCameras, AreNotSeenInViewsOfOne) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    for (const std::size_t count : {8U, 15U}) {
      const auto views = photograph(chessboard(), true_camera(), count, kNoise_px, seed);
      EXPECT_FALSE(find_two_cameras(chessboard(), named(views))) << seed;
    }
}

TEST(TwoCameras, AreNotSeenInViewsOfABentBoard) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    EXPECT_FALSE(find_two_cameras(chessboard(), named(photograph_bent(0.001, 15, seed)))) << seed;
}

TEST(TwoCameras, AreNotSeenWhereBoardsAreParallelToTheImage) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto views = photograph(chessboard(), true_camera(), 12, kNoise_px, seed,
                                  {.tilt_deg = 4.0, .nearest_m = 0.4, .farthest_m = 0.5});
    EXPECT_FALSE(find_two_cameras(chessboard(), named(views))) << seed;
  }
}

TEST(TwoCameras, AreNotSeenInViewsWithCornersFoundWrongly) {
  auto views = photograph(chessboard(), true_camera(), 15, kNoise_px, 5);
  for (const std::size_t i : {2U, 7U, 11U}) views[i][10 + i].pixel.x() += 12.0;
  EXPECT_FALSE(find_two_cameras(chessboard(), named(views)));
}

TEST(TwoCameras, AreLikelierTheLargerTheContrast) {
  const auto one = named(photograph(chessboard(), true_camera(), 12, kNoise_px, 8));
  const auto split = find_two_cameras(chessboard(), one, 0.0);
  ASSERT_TRUE(split);
  EXPECT_LT(split->contrast, kContrast);
  EXPECT_FALSE(find_two_cameras(chessboard(), one, 1.01 * split->contrast));
}

TEST(TwoCameras, NeedThreeViewsEach) {
  auto views = photograph(chessboard(), true_camera(), 3, kNoise_px, 6);
  for (auto& view : photograph(chessboard(), zoomed(1.5), 2, kNoise_px, 7)) views.push_back(std::move(view));
  EXPECT_FALSE(find_two_cameras(chessboard(), named(views)));
}

}  // namespace
}  // namespace waymark::calibrate
