#include "workbench/calibrate/board.hpp"

#include <gtest/gtest.h>

namespace waymark::calibrate {
namespace {

TEST(Board, GridSizesAreTwoWholeNumbers) {
  EXPECT_EQ(parse_grid_size("9x6"), (GridSize{9, 6}));
  EXPECT_EQ(parse_grid_size("5X7"), (GridSize{5, 7}));
  for (const char* text : {"", "9", "9x", "x6", "9x6x2", "-9x6", "9.5x6", "1x6", "9x1000", " 9x6"})
    EXPECT_FALSE(parse_grid_size(text)) << text;
}

TEST(Board, CornersAreCountedRowByRow) {
  const Board board{.corners = {9, 6}, .square_m = 0.025};
  EXPECT_EQ(board.size(), 54);
  EXPECT_EQ(board.corner_m(0), Eigen::Vector2d(0.0, 0.0));
  EXPECT_TRUE(board.corner_m(8).isApprox(Eigen::Vector2d(0.2, 0.0)));
  EXPECT_TRUE(board.corner_m(9).isApprox(Eigen::Vector2d(0.0, 0.025)));
}

TEST(Board, ChessboardMayLeaveOutWhatImagesTell) {
  const auto board = make_board({});
  ASSERT_TRUE(board) << board.error().message;
  EXPECT_EQ(board->size(), 0);
  EXPECT_FALSE(board->has_scale);
}

TEST(Board, CharucoHasACornerLessThanSquares) {
  const auto board = make_board({"charuco", "", "5x7", 0.04, 0.02, "6x6_250"});
  ASSERT_TRUE(board) << board.error().message;
  EXPECT_EQ(board->corners, (GridSize{4, 6}));
  EXPECT_EQ(describe(*board), "ChArUco board of 5x7 squares with 6x6_250 markers");
}

TEST(Board, WhatIsMissingOrContradictsIsNamed) {
  struct Case {
    BoardRequest request;
    const char* named;
  };
  const Case cases[] = {
      {{"circles"}, "--board circles"},
      {{.corners = "9"}, "--corners 9"},
      {{.corners = "2x6"}, "--corners 2x6"},
      {{.squares = "5x7"}, "--board charuco"},
      {{.corners = "9x6", .square_m = -1.0}, "--square_m"},
      {{.kind = "charuco", .corners = "9x6"}, "--squares"},
      {{.kind = "charuco", .squares = "5x7"}, "--marker_m"},
      {{"charuco", "", "5x7", 0.02, 0.04, "6x6_250"}, "--marker_m"},
      {{"charuco", "", "5x7", 0.04, 0.02, ""}, "--dictionary"},
      {{"charuco", "", "5x7", 0.04, 0.02, "36h11"}, "ArUco"},
      {{"charuco", "", "5x7", 0.04, 0.02, "6x6"}, "unknown dictionary"},
      {{"charuco", "", "20x20", 0.04, 0.02, "6x6_50"}, "has 50 markers"},
  };
  for (const auto& [request, named] : cases) {
    const auto board = make_board(request);
    ASSERT_FALSE(board) << named;
    EXPECT_NE(board.error().message.find(named), std::string::npos) << board.error().message;
  }
}

}  // namespace
}  // namespace waymark::calibrate
