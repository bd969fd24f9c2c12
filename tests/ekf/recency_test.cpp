#include "waymark/ekf/recency.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace waymark::ekf {
namespace {

/// Members 0 to 4, seen in the order 3, 0, 4, 1 and 2 together.
Recency five() {
  Recency recency(5);
  for (int i = 0; i < 5; ++i) recency.enter();
  for (const auto& seen : std::vector<std::vector<int>>{{3}, {0}, {4}, {1, 2}}) {
    recency.begin_update();
    for (const int member : seen) recency.mark_seen(member);
  }
  return recency;
}

std::vector<int> latest(Recency& recency, std::size_t count) {
  std::vector<int> taken;
  Recency::Latest latest = recency.latest(count);
  for (int member = 4; member >= 0; --member)
    if (latest.takes(recency.seen(member))) taken.push_back(member);
  return taken;
}

TEST(Recency, KnowsTheMembersThatWereSeenLast) {
  Recency recency = five();
  EXPECT_EQ(latest(recency, 1), (std::vector<int>{2}));  // of two, the first asked for
  EXPECT_EQ(latest(recency, 2), (std::vector<int>{2, 1}));
  EXPECT_EQ(latest(recency, 4), (std::vector<int>{4, 2, 1, 0}));
  EXPECT_EQ(latest(recency, 9), (std::vector<int>{4, 3, 2, 1, 0}));
}

TEST(Recency, WhatWasRemovedWasNeverSeen) {
  Recency recency = five();
  recency.mark_removed(2);
  EXPECT_TRUE(recency.is_removed(2));
  EXPECT_EQ(latest(recency, 2), (std::vector<int>{4, 1}));
  EXPECT_EQ(latest(recency, 5), (std::vector<int>{4, 3, 1, 0}));
}

TEST(Recency, TheLastMemberTakesThePlaceOfOneThatLeaves) {
  Recency recency = five();
  const Recency::Clock last = recency.seen(4);
  recency.leave(1);
  EXPECT_EQ(recency.seen(1), last);
}

TEST(Recency, CountsWhatIsSeenFromOnePlaceOnce) {
  Recency recency = five();
  recency.begin_step();
  for (int again = 0; again < 2; ++again) {
    recency.begin_update();
    for (const int member : {0, 1}) {
      recency.count(member);
      recency.mark_seen(member);
    }
  }
  recency.count(Recency::kNoMember);
  recency.mark_seen(Recency::kNoMember);
  EXPECT_EQ(recency.in_view(), 3);
  recency.begin_step();
  recency.begin_update();
  recency.count(0);
  EXPECT_EQ(recency.in_view(), 1);
  EXPECT_EQ(recency.max_in_view(), 3);
  recency.begin_submap();
  EXPECT_EQ(recency.max_in_view(), 1);
}

}  // namespace
}  // namespace waymark::ekf
