#include "workbench/calibrate/weaknesses.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "photographed_board.hpp"

namespace waymark::calibrate {
namespace {

using test::chessboard;
using test::named;
using test::photograph;
using test::true_camera;

std::string weaknesses_of(std::vector<BoardView> views) {
  const auto result = calibrate_camera(chessboard(), std::move(views));
  if (!result) return "error: " + result.error().message;
  std::string text;
  for (const auto& weakness : result->weaknesses) text += weakness.what + "\n";
  return text;
}

bool names(const std::string& text, const char* what) { return text.find(what) != std::string::npos; }

TEST(Weaknesses, FewViews) {
  const auto text = weaknesses_of(named(photograph(chessboard(), true_camera(), 5, 0.2, 1)));
  EXPECT_TRUE(names(text, "only 5 views")) << text;
}

TEST(Weaknesses, BoardsParallelToTheImage) {
  const auto text = weaknesses_of(named(photograph(chessboard(), true_camera(), 15, 0.2, 2,
                                                   {.tilt_deg = 3.0, .nearest_m = 0.45, .farthest_m = 0.5})));
  EXPECT_TRUE(names(text, "parallel to the image")) << text;
  EXPECT_TRUE(names(text, "focal length is uncertain by")) << text;
}

TEST(Weaknesses, OneCornerOfTheImage) {
  std::vector<BoardCorners> views;
  for (const auto& view : photograph(chessboard(), true_camera(), 400, 0.2, 3, {.farthest_m = 0.9}))
    if (std::ranges::all_of(view, [](const auto& c) { return c.pixel.x() < 360.0 && c.pixel.y() < 300.0; }))
      views.push_back(view);
  ASSERT_GE(views.size(), 10U);
  const auto text = weaknesses_of(named(views));
  EXPECT_TRUE(names(text, "of the image")) << text;
}

TEST(Weaknesses, LargeErrors) {
  const auto text = weaknesses_of(named(photograph(chessboard(), true_camera(), 15, 1.5, 4)));
  EXPECT_TRUE(names(text, "reprojection errors")) << text;
}

TEST(Weaknesses, TwoCamerasComeFirstByTheNamesOfTheirViews) {
  CameraOptions zoomed = true_camera();
  zoomed.fu_px *= 1.5;
  zoomed.fv_px *= 1.5;
  auto views = named(photograph(chessboard(), true_camera(), 10, 0.2, 6));
  for (auto& view : named(photograph(chessboard(), zoomed, 10, 0.2, 7))) {
    view.name = "near " + view.name;
    views.push_back(std::move(view));
  }
  views[4].fate = Fate::kNoBoard;
  const auto text = weaknesses_of(std::move(views));
  EXPECT_TRUE(text.starts_with("two cameras, or focus or zoom changed: view * (9 views")) << text;
  EXPECT_TRUE(names(text, " | near view * (10 views")) << text;
}

TEST(Weaknesses, EachSaysWhatToPhotograph) {
  const auto result =
      calibrate_camera(chessboard(), named(photograph(chessboard(), true_camera(), 4, 1.5, 5)));
  ASSERT_TRUE(result);
  EXPECT_GE(result->weaknesses.size(), 2U);
  for (const auto& weakness : result->weaknesses) EXPECT_FALSE(weakness.advice.empty());
}

}  // namespace
}  // namespace waymark::calibrate
