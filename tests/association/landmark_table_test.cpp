#include "waymark/association/landmark_table.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

LandmarkId marker(int number) { return {LandmarkId::Family::kMarker, number}; }

LandmarkRecord tentative(LandmarkId id) {
  return {.id = id, .identity = Identity::kUnknown, .existence = Existence{}};
}

/// Markers 10, 11, 12 at indices 0, 1, 2.
class ThreeLandmarks : public testing::Test {
 protected:
  ThreeLandmarks() : table_(8) {
    table_.begin_scan();
    for (int i = 10; i < 13; ++i) table_.append({.id = marker(i)});
  }
  LandmarkTable table_;
};

TEST_F(ThreeLandmarks, AreFoundByIdentity) {
  EXPECT_EQ(table_.size(), 3);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(table_.find(marker(10 + i)), i);
  EXPECT_FALSE(table_.find(marker(13)));
}

TEST_F(ThreeLandmarks, TheLastTakesThePlaceOfTheRemovedOne) {
  table_.observe(2);
  table_.remove(0);
  EXPECT_EQ(table_.size(), 2);
  EXPECT_FALSE(table_.find(marker(10)));
  EXPECT_EQ(table_.find(marker(11)), 1);
  EXPECT_EQ(table_.find(marker(12)), 0);
  EXPECT_EQ(table_[0].observations, 2);
  table_.remove(1);  // the last itself
  EXPECT_FALSE(table_.find(marker(11)));
  EXPECT_EQ(table_.find(marker(12)), 0);
}

TEST_F(ThreeLandmarks, RemovedOnesAreReportedForOneScan) {
  table_.remove(1);
  ASSERT_EQ(table_.removed().size(), 1U);
  EXPECT_EQ(table_.removed()[0], marker(11));
  table_.begin_scan();
  EXPECT_TRUE(table_.removed().empty());
}

TEST_F(ThreeLandmarks, KnowWhenTheyWereClaimedAndObserved) {
  EXPECT_TRUE(table_.is_claimed(0));
  EXPECT_TRUE(table_.is_observed(0));
  table_.begin_scan();
  EXPECT_FALSE(table_.is_claimed(0));
  table_.claim(0);
  EXPECT_TRUE(table_.is_claimed(0));
  EXPECT_FALSE(table_.is_observed(0));
  table_.observe(0);
  EXPECT_TRUE(table_.is_observed(0));
  EXPECT_EQ(table_[0].observations, 2);
  EXPECT_EQ(table_[1].observations, 1);
}

TEST_F(ThreeLandmarks, KnowHowFarTheRobotWentSinceTheyWereObserved) {
  table_.travel(2.0);
  table_.observe(1);
  table_.travel(3.0);
  EXPECT_DOUBLE_EQ(table_.travelled_since_m(0), 5.0);
  EXPECT_DOUBLE_EQ(table_.travelled_since_m(1), 3.0);
}

TEST_F(ThreeLandmarks, ATwinLeavesItsObservations) {
  table_.observe(1);
  table_.begin_scan();
  table_.absorb(0, 1);
  EXPECT_EQ(table_[0].observations, 3);
  EXPECT_TRUE(table_.is_observed(0));
}

TEST_F(ThreeLandmarks, NeverGrowStale) {
  table_.travel(1000.0);
  EXPECT_FALSE(table_.is_stale(0));
}

TEST(LandmarkTable, ATentativeLandmarkIsNotInTheMapUntilItIsConfirmed) {
  LandmarkTable table(4);
  table.append(tentative(table.unused_id()));
  EXPECT_FALSE(table.is_in_map(0));
  table.existence(0).confirm();
  EXPECT_TRUE(table.is_in_map(0));
}

TEST(LandmarkTable, ATentativeLandmarkIsStaleWhenItWasNotSeenForLong) {
  LandmarkTable table(4);
  table.append(tentative(table.unused_id()));
  table.travel(kTentativeDistance_m);
  EXPECT_FALSE(table.is_stale(0));
  table.travel(0.1);
  EXPECT_TRUE(table.is_stale(0));
  table.observe(0);
  EXPECT_FALSE(table.is_stale(0));
}

TEST(LandmarkTable, OfWhatIsNotInTheMapNoRemovalIsReported) {
  LandmarkTable table(4);
  table.append(tentative(table.unused_id()));
  table.append({.identity = Identity::kNoLandmark});
  table.remove(0);
  table.remove(0);
  EXPECT_TRUE(table.removed().empty());
  EXPECT_EQ(table.size(), 0);
}

TEST(LandmarkTable, NumbersForUnknownIdentitiesAreNotUsedTwice) {
  LandmarkTable table(8);
  table.append({.id = {LandmarkId::Family::kNone, 41}});  // from a saved map
  table.append({.id = marker(99)});
  table.append({.identity = Identity::kNoLandmark});
  EXPECT_EQ(table.unused_id().number, 42);
  table.append(tentative(table.unused_id()));
  EXPECT_FALSE(table.find({LandmarkId::Family::kNone, 42}));
  table.remove(3);
  EXPECT_EQ(table.unused_id().number, 43);
  EXPECT_EQ(table.find({LandmarkId::Family::kNone, 41}), 0);
}

}  // namespace
}  // namespace waymark
