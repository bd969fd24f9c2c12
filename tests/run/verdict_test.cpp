#include "workbench/run/verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

/// Of a run in which all is as it should be.
Evidence good_evidence() {
  Evidence evidence;
  evidence.matched = 1000;
  evidence.gated = 10;
  evidence.innovations = {1.0, 1000.0};
  evidence.blocks = {1.0, 100.0};
  evidence.departure = {1.0, 100.0};
  evidence.travelled_m = 50.0;
  return evidence;
}

TEST(Verdict, IsGoodWhereAllIsAsExpected) {
  const Verdict verdict = judge(good_evidence());
  EXPECT_EQ(verdict.level, Trust::kGood);
  EXPECT_THAT(verdict.reasons, Contains(HasSubstr("1000 observations")));
}

TEST(Verdict, TheGravestReasonDecidesAndComesFirst) {
  Evidence evidence = good_evidence();
  evidence.innovations.value = 4.0;
  evidence.health.lost = true;
  const Verdict verdict = judge(evidence);
  EXPECT_EQ(verdict.level, Trust::kDoNotTrust);
  ASSERT_THAT(verdict.reasons, SizeIs(2));
  EXPECT_THAT(verdict.reasons[0], HasSubstr("lost"));
  EXPECT_THAT(verdict.reasons[1], HasSubstr("innovations are 2.0 times as large as expected"));
}

TEST(Verdict, ErrorsThatAreMuchLargerThanExpectedAreNotToBeTrusted) {
  for (const auto ratio : {&Evidence::innovations, &Evidence::blocks, &Evidence::departure}) {
    Evidence evidence = good_evidence();
    (evidence.*ratio).value = 1.9;
    EXPECT_EQ(judge(evidence).level, Trust::kGood);
    (evidence.*ratio).value = 2.1;
    EXPECT_EQ(judge(evidence).level, Trust::kUnsure);
    (evidence.*ratio).value = 9.1;
    EXPECT_EQ(judge(evidence).level, Trust::kDoNotTrust);
  }
}

TEST(Verdict, WhatChanceExplainsIsNoReason) {
  Evidence evidence = good_evidence();
  evidence.departure = {2.3, 10.0};  // 99 % of chi-square with 10 degrees of freedom: 23.2
  EXPECT_EQ(judge(evidence).level, Trust::kGood);
  evidence.departure = {2.4, 10.0};
  EXPECT_EQ(judge(evidence).level, Trust::kUnsure);
}

TEST(Verdict, ErrorsThatAreMuchSmallerThanExpectedMakeItUnsure) {
  Evidence evidence = good_evidence();
  evidence.innovations.value = 0.1;
  EXPECT_EQ(judge(evidence).level, Trust::kUnsure);
}

TEST(Verdict, AFewObservationsProveNothing) {
  Evidence evidence = good_evidence();
  evidence.innovations = {1.0, 9.0};
  EXPECT_EQ(judge(evidence).level, Trust::kUnsure);
}

TEST(Verdict, AScanThatFitsNothingMakesItUnsure) {
  Evidence evidence = good_evidence();
  evidence.misfit = {169.3, 17, 16, -4.0};
  EXPECT_EQ(judge(evidence).level, Trust::kGood);
  evidence.misfit.log_probability = -5.0;
  const Verdict verdict = judge(evidence);
  EXPECT_EQ(verdict.level, Trust::kUnsure);
  EXPECT_THAT(verdict.reasons, Contains(HasSubstr("16 of 17 observations 169.3 s after the start")));
}

TEST(Verdict, DeadReckoningIsNotToBeTrusted) {
  Evidence evidence = good_evidence();
  evidence.matched = 0;
  EXPECT_EQ(judge(evidence).level, Trust::kDoNotTrust);
  evidence.deferred = 70;
  const Verdict verdict = judge(evidence);
  EXPECT_EQ(verdict.level, Trust::kDoNotTrust);
  EXPECT_THAT(
      verdict.reasons,
      Contains(HasSubstr("from 70 observations of range or bearing alone: this path is dead reckoning")));
}

TEST(Verdict, WhereTheTruthIsKnownTheNeesHasTheLastWord) {
  EXPECT_EQ(judge(good_evidence(), 5.9).level, Trust::kGood);
  EXPECT_EQ(judge(good_evidence(), 6.1).level, Trust::kUnsure);
  const Verdict verdict = judge(good_evidence(), 62.0);
  EXPECT_EQ(verdict.level, Trust::kDoNotTrust);
  EXPECT_THAT(verdict.reasons, Contains(HasSubstr("mean NEES 62")));
}

}  // namespace
}  // namespace waymark
