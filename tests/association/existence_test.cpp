#include "waymark/association/existence.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

AssociationModel model() {
  return {{.false_alarm_probability = 0.02}, {.max_range_m = 10.0, .detection_probability = 0.9}};
}

TEST(Existence, IsTentativeUntilSeenAgain) {
  Existence existence;
  EXPECT_FALSE(existence.is_confirmed());
  EXPECT_FALSE(existence.is_false_track());
  EXPECT_DOUBLE_EQ(existence.probability(), 0.5);
  existence.see(model());
  EXPECT_FALSE(existence.is_confirmed());
  existence.see(model());  // 2 log(0.9 / 0.02) = 7.6
  EXPECT_TRUE(existence.is_confirmed());
}

TEST(Existence, OneMissEndsWhatWasSeenOnce) {
  Existence existence;
  existence.miss(model());
  EXPECT_TRUE(existence.is_false_track());
}

TEST(Existence, CertaintyEndsSoThatAFalseTrackCanGo) {
  Existence existence;
  for (int i = 0; i < 1000; ++i) existence.see(model());
  EXPECT_DOUBLE_EQ(existence.log_odds(), 12.0);
  int misses = 0;
  for (; !existence.is_false_track(); ++misses) existence.miss(model());
  EXPECT_EQ(misses, 6);  // log(0.1 / 0.98) = -2.3
  EXPECT_TRUE(existence.is_confirmed());
}

TEST(Existence, WhatIsCertainStaysSo) {
  Existence existence = Existence::certain();
  for (int i = 0; i < 3; ++i) existence.miss(model());
  existence.see(model());
  EXPECT_TRUE(existence.is_certain());
  EXPECT_TRUE(existence.is_confirmed());
  EXPECT_FALSE(existence.is_false_track());
  EXPECT_EQ(existence.probability(), 1.0);
  EXPECT_FALSE(Existence{}.is_certain());
}

}  // namespace
}  // namespace waymark
