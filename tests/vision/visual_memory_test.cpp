#include "waymark/vision/visual_memory.hpp"

#include <set>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "waymark/core/random.hpp"

namespace waymark::vision {
namespace {

LandmarkId corner(int number) { return {LandmarkId::Family::kCorner, number}; }

ReferencePatch grey_patch(int grey) {
  ReferencePatch patch;
  patch.pixels.fill(static_cast<std::uint8_t>(grey));
  return patch;
}

int grey_of(const Appearance* appearance) { return appearance->patch.patch()(0, 0); }

TEST(VisualMemory, HoldsWhatItWasToldUntilItIsToForget) {
  VisualMemory memory(16);
  std::set<int> known;
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 3000; ++i) {
    const int number = static_cast<int>(random.uniform(0.0, 200.0));
    if (random.uniform(0.0, 1.0) < 0.5) {
      memory.remember(corner(number), grey_patch(number), {}, {});
      known.insert(number);
    } else {
      memory.forget(corner(number));
      known.erase(number);
    }
    ASSERT_EQ(memory.size(), known.size());
    for (int n = 0; n < 200; ++n) {
      const Appearance* found = memory.find(corner(n));
      ASSERT_EQ(found != nullptr, known.contains(n));
      if (found != nullptr) {
        ASSERT_EQ(grey_of(found), n);
      }
    }
  }
}

TEST(VisualMemory, TellsFamiliesApartAndReplacesWhatItKnew) {
  VisualMemory memory(16);
  memory.remember(corner(3), grey_patch(10), {}, {});
  EXPECT_EQ(memory.find({LandmarkId::Family::kMarker, 3}), nullptr);
  memory.remember(corner(3), grey_patch(20), {}, {});
  EXPECT_EQ(grey_of(memory.find(corner(3))), 20);
  EXPECT_EQ(memory.size(), 1U);
}

TEST(VisualMemory, AllocatesNothingWhileItHoldsFewerThanItHasRoomFor) {
  VisualMemory memory(16);
  const test::AllocationCount count;
  for (int i = 0; i < 1000; ++i) {
    memory.remember(corner(i), grey_patch(i % 256), {}, {});
    if (i >= 100) memory.forget(corner(i - 100));
  }
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::vision
