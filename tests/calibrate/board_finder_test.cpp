#include "workbench/calibrate/board_finder.hpp"

#include <gtest/gtest.h>

#include "photographed_board.hpp"

namespace waymark::calibrate {
namespace {

TEST(BoardFinder, FindsTheCornersOfADrawnChessboardToAFewHundredths) {
  const Board board = test::chessboard();
  auto finder = make_board_finder(board);
  ASSERT_TRUE(finder) << finder.error().message;
  for (const double turn_rad : {0.0, 0.1, -0.2}) {
    const test::DrawnBoard drawn{.v = 110.0, .turn_rad = turn_rad};
    const auto corners = (*finder)->find(drawn.draw(board, 480, 400));
    ASSERT_TRUE(corners) << turn_rad;
    ASSERT_EQ(corners->size(), 54U);
    // The first may be either end of the board.
    const bool reversed = ((*corners)[0].pixel - drawn.corner(board, 0)).norm() > 10.0;
    for (const auto& [index, pixel] : *corners)
      EXPECT_LT((pixel - drawn.corner(board, reversed ? 53 - index : index)).norm(), 0.05) << index;
  }
}

TEST(BoardFinder, FindsNothingWhereThereIsNothing) {
  auto finder = make_board_finder(test::chessboard());
  ASSERT_TRUE(finder);
  EXPECT_FALSE((*finder)->find(GreyImage(320, 240, 128)));
  EXPECT_FALSE((*finder)->find(GreyImage(3, 3, 128)));
}

TEST(BoardFinder, GuessesHowManyCornersABoardHas) {
  const Board board = test::chessboard();
  EXPECT_EQ(guess_chessboard(test::DrawnBoard{}.draw(board, 480, 400)), (GridSize{9, 6}));
  EXPECT_FALSE(guess_chessboard(GreyImage(320, 240, 128)));
}

}  // namespace
}  // namespace waymark::calibrate
