#include "waymark/association/id_index.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

using Family = LandmarkId::Family;

TEST(IdIndex, FindsWhatWasAssigned) {
  IdIndex index(4);
  index.assign({Family::kMarker, 7}, 0);
  index.assign({Family::kBarcode, 7}, 1);  // another family, another landmark
  EXPECT_EQ(index.find({Family::kMarker, 7}), 0);
  EXPECT_EQ(index.find({Family::kBarcode, 7}), 1);
  EXPECT_EQ(index.find({Family::kMarker, 8}), std::nullopt);
}

TEST(IdIndex, MovesAndForgets) {
  IdIndex index(4);
  index.assign({Family::kMarker, -3}, 5);
  index.assign({Family::kMarker, -3}, 2);
  EXPECT_EQ(index.find({Family::kMarker, -3}), 2);
  index.erase({Family::kMarker, -3});
  EXPECT_EQ(index.find({Family::kMarker, -3}), std::nullopt);
}

}  // namespace
}  // namespace waymark
