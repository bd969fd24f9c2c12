#include "workbench/run/pose_losses.hpp"

#include <gmock/gmock.h>

namespace waymark {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Stamp at(double t_s) { return stamp_from_seconds(t_s); }

TEST(PoseLosses, AreNoneWhereAllIsWell) {
  PoseLosses losses;
  for (int i = 0; i < 9; ++i) losses.add(at(i), {.false_firsts = i, .carried = 1});
  EXPECT_TRUE(losses.slips().empty());
  EXPECT_TRUE(losses.lost().empty());
  EXPECT_TRUE(describe(losses, at(0.0)).empty());
}

TEST(PoseLosses, LastFromDoubtToRecovery) {
  PoseLosses losses;
  losses.add(at(1.0), {});
  losses.add(at(2.0), {.lost = true});
  losses.add(at(3.0), {.lost = true});
  losses.add(at(4.0), {.recoveries = 1});
  losses.add(at(5.0), {.recoveries = 1});
  ASSERT_EQ(losses.lost().size(), 1U);
  EXPECT_EQ(losses.lost()[0].from, at(2.0));
  EXPECT_EQ(losses.lost()[0].found, at(4.0));
  EXPECT_THAT(describe(losses, at(1.0)), ElementsAre(HasSubstr("lost from 1.0 to 3.0 s after the start")));
}

TEST(PoseLosses, MayEndInTheStepInWhichTheyAreFound) {
  PoseLosses losses;
  losses.add(at(1.0), {.recoveries = 1});
  losses.add(at(2.0), {.recoveries = 1});
  ASSERT_EQ(losses.lost().size(), 1U);
  EXPECT_EQ(losses.lost()[0].found, at(1.0));
}

TEST(PoseLosses, OpenOnesLastToTheEnd) {
  PoseLosses losses;
  losses.add(at(1.0), {.recoveries = 1, .lost = true});
  losses.add(at(2.0), {.recoveries = 1, .lost = true});
  EXPECT_THAT(describe(losses, at(0.0)), ElementsAre(HasSubstr("lost from 1.0 s to the end")));
}

TEST(PoseLosses, EndWhereTheMapFitsAgain) {
  PoseLosses losses;
  losses.add(at(1.0), {.lost = true});
  losses.add(at(2.0), {});
  ASSERT_EQ(losses.lost().size(), 1U);
  EXPECT_EQ(losses.lost()[0].found, at(2.0));
}

TEST(PoseLosses, NameFewOfManySlips) {
  PoseLosses losses;
  for (int i = 1; i <= 8; ++i) losses.add(at(i), {.slips = i});
  EXPECT_EQ(losses.slips().size(), 8U);
  EXPECT_THAT(describe(losses, at(0.0)), ElementsAre(HasSubstr("at 5.0 s and 3 times more after the start")));
}

}  // namespace
}  // namespace waymark
