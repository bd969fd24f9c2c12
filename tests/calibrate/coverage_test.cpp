#include "workbench/calibrate/coverage.hpp"

#include <gmock/gmock.h>

namespace waymark::calibrate {
namespace {

BoardView with_corners(std::initializer_list<Eigen::Vector2d> pixels) {
  BoardView view;
  for (const auto& pixel : pixels) view.corners.push_back({0, pixel});
  return view;
}

TEST(Coverage, CountsCellsOnce) {
  const BoardView view = with_corners({{1.0, 1.0}, {2.0, 3.0}, {639.4, 479.4}, {-0.4, 479.0}});
  EXPECT_DOUBLE_EQ(covered_part({view, view}, {640, 480}), 3.0 / 48.0);
}

TEST(Coverage, OnlyOfViewsThatAreUsed) {
  BoardView view = with_corners({{1.0, 1.0}});
  view.fate = Fate::kOutlier;
  EXPECT_EQ(covered_part({view}, {640, 480}), 0.0);
}

TEST(Coverage, NamesWhereNothingWasSeen) {
  const BoardView view =
      with_corners({{1.0, 1.0}, {300.0, 240.0}, {600.0, 240.0}, {100.0, 240.0}, {320.0, 10.0}});
  EXPECT_THAT(empty_ninths({view}, {640, 480}),
              testing::ElementsAre("upper right", "lower left", "bottom", "lower right"));
}

}  // namespace
}  // namespace waymark::calibrate
