#include "waymark/association/recovery.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace waymark {
namespace {

std::vector<Innovation> scan_of(std::initializer_list<Outcome> outcomes) {
  std::vector<Innovation> scan;
  for (const Outcome outcome : outcomes) scan.push_back({.outcome = outcome});
  return scan;
}

const std::vector<Innovation> kGatedOnce = scan_of({Outcome::kGated});

TEST(Recovery, FiveGatedInARowMeanALostRobot) {
  Recovery recovery;
  for (int scan = 0; scan < 4; ++scan) EXPECT_FALSE(recovery.is_lost(kGatedOnce));
  EXPECT_TRUE(recovery.is_lost(kGatedOnce));
}

TEST(Recovery, AnAcceptedOneBetweenThemMeansThatTheyAreWrong) {
  Recovery recovery;
  for (int scan = 0; scan < 4; ++scan) EXPECT_FALSE(recovery.is_lost(kGatedOnce));
  EXPECT_FALSE(recovery.is_lost(scan_of({Outcome::kMatched, Outcome::kGated})));
  EXPECT_FALSE(recovery.is_lost(kGatedOnce));
}

TEST(Recovery, WhatWasNotGatedSaysNothing) {
  Recovery recovery;
  for (int scan = 0; scan < 4; ++scan)
    EXPECT_FALSE(recovery.is_lost(scan_of({Outcome::kGated, Outcome::kAdded, Outcome::kUnusable})));
  EXPECT_TRUE(recovery.is_lost(kGatedOnce));
}

TEST(Recovery, AScanThatIsHalfAcceptedIsNotOfALostRobot) {
  Recovery recovery;
  std::vector<Innovation> half(12, {.outcome = Outcome::kMatched});
  for (std::size_t i = 6; i < half.size(); ++i) half[i].outcome = Outcome::kGated;
  EXPECT_FALSE(recovery.is_lost(half));
  half.front().outcome = Outcome::kGated;
  EXPECT_TRUE(recovery.is_lost(half));
}

TEST(Recovery, InflatesUntilHalfOfTheScanIsBelieved) {
  Recovery recovery;
  std::vector<Innovation> scan(5, kGatedOnce.front());
  ASSERT_TRUE(recovery.is_lost(scan));
  std::vector<double> sigmas;
  recovery.recover(scan, [&](const Motion& added_motion) {
    EXPECT_TRUE(added_motion.covariance.isDiagonal());
    EXPECT_EQ(added_motion.increment, Pose2{});
    sigmas.push_back(std::sqrt(added_motion.covariance(0, 0)));
    scan[sigmas.size() - 1].outcome = Outcome::kMatched;
  });
  ASSERT_EQ(sigmas.size(), 3U);
  EXPECT_DOUBLE_EQ(sigmas[0], 0.02);
  EXPECT_DOUBLE_EQ(sigmas[1], 0.04);
  EXPECT_DOUBLE_EQ(sigmas[2], 0.08);
  EXPECT_EQ(recovery.recoveries(), 1);
}

TEST(Recovery, InflationIsBounded) {
  Recovery recovery;
  const std::vector<Innovation> scan(5, kGatedOnce.front());
  double variance = 0.0;
  recovery.recover(scan, [&](const Motion& added_motion) { variance += added_motion.covariance(2, 2); });
  EXPECT_GT(std::sqrt(variance), 2.0);
  EXPECT_LT(std::sqrt(variance), 4.0);
}

TEST(Recovery, CountsAnewAfterARecovery) {
  Recovery recovery;
  const std::vector<Innovation> scan(5, kGatedOnce.front());
  ASSERT_TRUE(recovery.is_lost(scan));
  recovery.recover(scan, [](const Motion&) {});
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(recovery.is_lost(kGatedOnce));
}

}  // namespace
}  // namespace waymark
