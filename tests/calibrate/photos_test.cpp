// Photographs of real boards.

#include <algorithm>

#include <gtest/gtest.h>

#include "support/data_dir.hpp"

#include "workbench/calibrate/camera_calibration.hpp"

namespace waymark::calibrate {
namespace {

Result<CameraCalibration> calibrate(const std::string& pattern, const Board& board) {
  auto images = open_images({waymark::test::data_path(pattern).string()});
  if (!images) return images.error();
  auto finder = make_board_finder(board);
  if (!finder) return finder.error();
  auto views = collect_views(**images, board, **finder);
  if (!views) return views.error();
  return calibrate_camera(board, *std::move(views));
}

TEST(Photos, OfAGoodSetFitWellAlsoThoseLeftOut) {
  WAYMARK_REQUIRE_DATA("calib-chessboard");
  for (const char* pattern : {"calib-chessboard/left*.jpg", "calib-chessboard/right*.jpg"}) {
    const auto result = calibrate(pattern, {.corners = {9, 6}, .square_m = 0.025});
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->used(), 13U);
    EXPECT_LE(result->fit.rms_px, 0.20);
    EXPECT_LE(result->held_out.rms_px, 0.25);
    EXPECT_FALSE(result->is_weak()) << result->weaknesses[0].what;
  }
}

TEST(Photos, OfTwoCamerasAreToldApart) {
  WAYMARK_REQUIRE_DATA("calib-chessboard");
  const auto result = calibrate("calib-chessboard", {.corners = {9, 6}, .square_m = 0.025});
  ASSERT_TRUE(result) << result.error().message;
  ASSERT_TRUE(result->two_cameras);
  for (const auto& group : result->two_cameras->groups) {
    EXPECT_EQ(group.views.size(), 13U);
    EXPECT_LE(group.rms_px, 0.20);
    for (const std::size_t i : group.views)
      EXPECT_EQ(result->views[i].name[0], result->views[group.views[0]].name[0]);
  }
  ASSERT_TRUE(result->is_weak());
  const std::string& what = result->weaknesses[0].what;
  EXPECT_NE(what.find("left*.jpg (13 views) | right*.jpg (13 views)"), std::string::npos) << what;
}

TEST(Photos, OfABoardInAHandThatShakesAreWeak) {
  WAYMARK_REQUIRE_DATA("saut-pioneer");
  const auto result = calibrate("saut-pioneer/calibration", {.corners = {8, 6}});
  ASSERT_TRUE(result) << result.error().message;
  const auto says = [&](const char* what) {
    return std::ranges::any_of(result->weaknesses, [&](const Weakness& weakness) {
      return weakness.what.find(what) != std::string::npos;
    });
  };
  EXPECT_TRUE(says("the focal length is uncertain by"));
  EXPECT_TRUE(says("the principal point"));
  EXPECT_TRUE(says("views left out of the fit"));
  EXPECT_FALSE(result->two_cameras);
}

TEST(Photos, OfACharucoBoardAreTooFew) {
  WAYMARK_REQUIRE_DATA("marker-photos");
  const auto board = make_board({"charuco", "", "5x7", 0.04, 0.02, "6x6_250"});
  ASSERT_TRUE(board);
  const auto result = calibrate("marker-photos/ch*.jpg", *board);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("at least"), std::string::npos) << result.error().message;
}

TEST(Photos, OfACharucoBoardShowAllItsCorners) {
  WAYMARK_REQUIRE_DATA("marker-photos");
  const auto board = make_board({"charuco", "", "5x7", 0.04, 0.02, "6x6_250"});
  const auto finder = make_board_finder(*board);
  const auto photo = read_image(waymark::test::data_path("marker-photos/choriginal.jpg"));
  ASSERT_TRUE(finder && photo);
  const auto corners = (*finder)->find(*photo);
  ASSERT_TRUE(corners);
  EXPECT_EQ(corners->size(), 24U);
}

}  // namespace
}  // namespace waymark::calibrate
