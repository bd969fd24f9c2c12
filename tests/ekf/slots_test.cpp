#include "waymark/ekf/slots.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace waymark::ekf {
namespace {

/// Landmarks 0 to 3 in the slots 0 to 3, all in the submap.
Slots four() {
  Slots slots(4, 4);
  for (int i = 0; i < 4; ++i) {
    const int slot = slots.take_unused();
    slots.enter(slot);
    slots.append(slot);
  }
  return slots;
}

TEST(Slots, TheLastMemberTakesThePlaceOfOneThatLeaves) {
  Slots slots = four();
  EXPECT_EQ(slots.leave(1), 1);
  EXPECT_EQ(slots.members(), (std::vector<int>{0, 3, 2}));
  EXPECT_EQ(slots.local_of(3), 1);
  EXPECT_FALSE(slots.is_active(1));
  EXPECT_EQ(slots.leave(2), 2);  // the last one itself
  EXPECT_EQ(slots.members(), (std::vector<int>{0, 3}));
  EXPECT_FALSE(slots.is_active(2));
  slots.enter(1);
  EXPECT_EQ(slots.local_of(1), 2);
}

TEST(Slots, TheLastLandmarkTakesTheIndexOfARemovedOne) {
  Slots slots = four();
  slots.remove(1);
  EXPECT_EQ(slots.landmarks(), 3);
  EXPECT_EQ(slots.slot_of(1), 3);
  EXPECT_EQ(slots.local_of(1), 3);
  EXPECT_EQ(slots.members(), (std::vector<int>{0, 1, 2, 3}));  // the submap still holds its place
}

TEST(Slots, FreedSlotsAreUsedAgain) {
  Slots slots(1, 1);
  EXPECT_EQ(slots.take_unused(), 0);
  EXPECT_TRUE(slots.has_unused());
  EXPECT_EQ(slots.take_unused(), 1);
  EXPECT_FALSE(slots.has_unused());
  EXPECT_FALSE(slots.has_freed());
  slots.free(0);
  EXPECT_TRUE(slots.has_freed());
  EXPECT_EQ(slots.take_freed(), 0);
  EXPECT_FALSE(slots.has_freed());
}

}  // namespace
}  // namespace waymark::ekf
