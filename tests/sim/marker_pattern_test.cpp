#include "workbench/sim/marker_pattern.hpp"

#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace waymark::sim {
namespace {

std::vector<bool> cells(int number, int quarter_turns) {
  std::vector<bool> all;
  for (int row = 0; row < kMarkerCells; ++row)
    for (int column = 0; column < kMarkerCells; ++column) {
      int u = column, v = row;
      for (int i = 0; i < quarter_turns; ++i) {
        const int turned = kMarkerCells - 1 - v;
        v = u;
        u = turned;
      }
      all.push_back(is_white(number, u, v));
    }
  return all;
}

TEST(MarkerPattern, NoTwoLookAlikeHoweverTurned) {
  std::set<std::vector<bool>> seen;
  for (int number = 0; number < kMarkerPatterns; ++number)
    for (int turns = 0; turns < 4; ++turns) seen.insert(cells(number, turns));
  EXPECT_EQ(seen.size(), 4U * kMarkerPatterns);
}

TEST(MarkerPattern, IsBlackWithinWhite) {
  for (int i = 0; i < kMarkerCells; ++i) {
    EXPECT_TRUE(is_white(7, i, 0));
    EXPECT_TRUE(is_white(7, kMarkerCells - 1, i));
  }
  for (int i = 1; i < kMarkerCells - 1; ++i) {
    EXPECT_FALSE(is_white(7, i, 1));
    EXPECT_FALSE(is_white(7, kMarkerCells - 2, i));
  }
}

TEST(MarkerPattern, IsPaintedCellByCell) {
  const Canvas canvas = paint_marker(3);
  EXPECT_EQ(canvas.width(), kMarkerCells * kTexelsPerMarkerCell);
  for (int row = 0; row < kMarkerCells; ++row)
    for (int column = 0; column < kMarkerCells; ++column) {
      const float grey = canvas.at(column * kTexelsPerMarkerCell, row * kTexelsPerMarkerCell);
      EXPECT_EQ(grey > 128.0F, is_white(3, column, row));
      EXPECT_EQ(canvas.at((column + 1) * kTexelsPerMarkerCell - 1, (row + 1) * kTexelsPerMarkerCell - 1),
                grey);
    }
}

}  // namespace
}  // namespace waymark::sim
