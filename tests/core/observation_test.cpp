#include "waymark/core/observation.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

using Family = LandmarkId::Family;

TEST(LandmarkId, IsTheSameOnlyWithTheSameFamilyAndNumber) {
  EXPECT_EQ((LandmarkId{Family::kMarker, 7}), (LandmarkId{Family::kMarker, 7}));
  EXPECT_NE((LandmarkId{Family::kMarker, 7}), (LandmarkId{Family::kBarcode, 7}));
  EXPECT_NE((LandmarkId{Family::kMarker, 7}), (LandmarkId{Family::kMarker, 8}));
}

TEST(LandmarkId, IsOrderedByFamilyThenNumber) {
  EXPECT_LT((LandmarkId{Family::kMarker, 9}), (LandmarkId{Family::kBarcode, 1}));
  EXPECT_LT((LandmarkId{Family::kMarker, 1}), (LandmarkId{Family::kMarker, 9}));
}

TEST(LandmarkId, ReadsAsItsNumber) { EXPECT_EQ(to_string(LandmarkId{Family::kMarker, 42}), "42"); }

}  // namespace
}  // namespace waymark
