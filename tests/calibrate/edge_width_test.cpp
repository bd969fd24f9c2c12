#include "workbench/calibrate/edge_width.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "photographed_board.hpp"

namespace waymark::calibrate {
namespace {

BoardCorners corners_of(const test::DrawnBoard& drawn, const Board& board) {
  BoardCorners corners;
  for (int i = 0; i < board.size(); ++i) corners.push_back({i, drawn.corner(board, i)});
  return corners;
}

TEST(EdgeWidth, OfAGaussianBlurIsTheDistanceFromTenToNinetyPercent) {
  constexpr double kTenToNinety = 2.5631;  // of the normal distribution, standard deviations
  const Board board = test::chessboard();
  for (const double blur_px : {1.0, 2.0, 3.0}) {
    const test::DrawnBoard drawn{.blur_px = blur_px};
    const double width_px = edge_width_px(drawn.draw(board, 480, 360), board, corners_of(drawn, board));
    // Looking between pixels blurs by a variance of 1/6 px^2 more.
    EXPECT_NEAR(width_px, kTenToNinety * std::sqrt(blur_px * blur_px + 1.0 / 6.0), 0.1 * blur_px);
  }
}

TEST(EdgeWidth, OfNothingIsNothing) {
  const Board board = test::chessboard();
  EXPECT_EQ(edge_width_px(GreyImage(480, 360, 90), board, corners_of({}, board)), 0.0);
  EXPECT_EQ(edge_width_px(GreyImage(480, 360, 90), board, {}), 0.0);
}

}  // namespace
}  // namespace waymark::calibrate
