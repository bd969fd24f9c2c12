#include "workbench/calibrate/folds.hpp"

#include <numeric>

#include <gtest/gtest.h>

namespace waymark::calibrate {
namespace {

using Places = std::vector<std::size_t>;

TEST(Folds, OfFewPlacesLeaveEachOutAlone) {
  const auto folds = folds_of({2, 5, 7});
  ASSERT_EQ(folds.size(), 3U);
  EXPECT_EQ(folds[1].left_out, Places({5}));
  EXPECT_EQ(folds[1].rest, Places({2, 7}));
}

TEST(Folds, OfManyPlacesLeaveEachOutOnceAndNeighboursTogether) {
  Places places(23);
  std::iota(places.begin(), places.end(), 4);
  const auto folds = folds_of(places);
  ASSERT_EQ(folds.size(), kMaxFolds);
  Places all;
  for (const Fold& fold : folds) {
    EXPECT_EQ(fold.rest.size() + fold.left_out.size(), places.size());
    EXPECT_EQ(fold.left_out.back() - fold.left_out.front() + 1, fold.left_out.size());
    all.insert(all.end(), fold.left_out.begin(), fold.left_out.end());
  }
  EXPECT_EQ(all, places);
}

}  // namespace
}  // namespace waymark::calibrate
