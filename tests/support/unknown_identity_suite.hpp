#pragma once

#include <algorithm>
#include <cstddef>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/circle_world.hpp"
#include "support/unknown_identity_observations.hpp"

namespace waymark::test {

/// What every filter must do with observations that have no identity. A Kind says which filter: make(world),
/// and make_small(world) for a map of five landmarks.
template <class Kind>
class UnknownIdentityFilter : public testing::Test {};

TYPED_TEST_SUITE_P(UnknownIdentityFilter);

TYPED_TEST_P(UnknownIdentityFilter, FindsEveryLandmarkOnceAmongClutter) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CircleWorld world(seed);
    auto filter = TypeParam::make(world);
    drive(filter, world, 300, seed);
    const Snapshot snapshot = filter.snapshot();
    EXPECT_EQ(snapshot.landmarks.size(), world.landmarks().size());
    for (const auto& p : world.landmarks()) EXPECT_LT(nearest_m(snapshot, p), 0.5);
    EXPECT_LT((filter.pose().T_world_robot.position() - world.truth().position()).norm(), 0.5);
  }
}

TYPED_TEST_P(UnknownIdentityFilter, ASingleObservationIsNotInTheMapYet) {
  CircleWorld world(2);
  auto filter = TypeParam::make(world);
  EXPECT_EQ(filter.correct(without_identity(world.look())).count(Outcome::kAdded), 8);
  EXPECT_TRUE(filter.snapshot().landmarks.empty());
  EXPECT_TRUE(filter.save().ids.empty());
  drive(filter, world, 3);
  EXPECT_EQ(filter.snapshot().landmarks.size(), 8U);
  EXPECT_EQ(filter.save().ids.size(), 8U);
}

TYPED_TEST_P(UnknownIdentityFilter, ALandmarkThatIsSeenNoMoreIsDeletedAndReported) {
  CircleWorld world(3);
  auto filter = TypeParam::make(world);
  drive(filter, world, 20);
  ASSERT_EQ(filter.snapshot().landmarks.size(), 8U);
  std::size_t removed = 0;
  for (int i = 0; i < 20; ++i) {
    filter.predict(world.move());
    auto scan = without_identity(world.look());
    scan.erase(scan.begin() + 2);
    removed += filter.correct(scan).removed.size();
  }
  EXPECT_EQ(removed, 1U);
  const Snapshot snapshot = filter.snapshot();
  EXPECT_EQ(snapshot.landmarks.size(), 7U);
  EXPECT_GT(nearest_m(snapshot, world.landmarks()[2]), 1.0);
}

TYPED_TEST_P(UnknownIdentityFilter, IdentitiesCountWhereThereAreAny) {
  CircleWorld world(4);
  auto filter = TypeParam::make(world);
  for (int i = 0; i < 30; ++i) {
    filter.predict(world.move());
    auto scan = world.look();
    for (std::size_t k = 4; k < scan.size(); ++k) scan[k].id.reset();
    filter.correct(scan);
  }
  const auto landmarks = filter.snapshot().landmarks;
  EXPECT_EQ(landmarks.size(), 8U);
  EXPECT_EQ(std::ranges::count(landmarks, LandmarkId::Family::kMarker,
                               [](const LandmarkEstimate& each) { return each.id.family; }),
            4);
}

TYPED_TEST_P(UnknownIdentityFilter, AnObservationOfUnknownIdentityMayBeOfALandmarkWithIdentity) {
  CircleWorld world(5);
  auto filter = TypeParam::make(world);
  filter.correct(world.look());
  filter.predict(world.move());
  EXPECT_EQ(filter.correct(without_identity(world.look())).count(Outcome::kMatched), 8);
}

TYPED_TEST_P(UnknownIdentityFilter, ASteadyStateStepAllocatesNothing) {
  CircleWorld world(8);
  auto filter = TypeParam::make(world);
  drive(filter, world, 200);
  const Steps steps = cluttered_steps(world, 50, 3);
  int added = 0;
  const AllocationCount count;
  for (const auto& [motion, scan] : steps) {
    filter.predict(motion);
    added += filter.correct(scan).count(Outcome::kAdded);
  }
  EXPECT_EQ(count.allocations(), 0);
  EXPECT_GT(added, 0);
}

TYPED_TEST_P(UnknownIdentityFilter, AFullMapSaysSo) {
  CircleWorld world(9);
  auto filter = TypeParam::make_small(world);
  const Correction& correction = filter.correct(without_identity(world.look()));
  EXPECT_EQ(correction.count(Outcome::kAdded), 5);
  EXPECT_EQ(correction.count(Outcome::kMapFull), 3);
}

REGISTER_TYPED_TEST_SUITE_P(UnknownIdentityFilter, FindsEveryLandmarkOnceAmongClutter,
                            ASingleObservationIsNotInTheMapYet, ALandmarkThatIsSeenNoMoreIsDeletedAndReported,
                            IdentitiesCountWhereThereAreAny,
                            AnObservationOfUnknownIdentityMayBeOfALandmarkWithIdentity,
                            ASteadyStateStepAllocatesNothing, AFullMapSaysSo);

}  // namespace waymark::test
