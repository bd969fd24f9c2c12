#include "waymark/association/greedy_match.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace waymark {
namespace {

constexpr int kNothing = GreedyMatch::kNothing;

GreedyMatch solved(const std::vector<ScoredPair>& pairs, int observations, int landmarks,
                   double margin = 3.0) {
  GreedyMatch match;
  for (const ScoredPair& pair : pairs) match.add(pair);
  match.solve(observations, landmarks, margin);
  return match;
}

TEST(GreedyMatch, TakesTheBestPairsOneToOne) {
  const auto match = solved({{0, 0, 5.0}, {0, 1, 9.0}, {1, 1, 8.0}, {1, 2, 1.0}, {2, 0, -1.0}}, 3, 3, 0.0);
  EXPECT_EQ(match.landmark_of(0), 1);
  EXPECT_EQ(match.landmark_of(1), 2);
  EXPECT_EQ(match.landmark_of(2), kNothing);
}

TEST(GreedyMatch, WhatScoresLessThanNothingKnownIsNotMatched) {
  const auto match = solved({{0, 0, -0.1}}, 1, 1);
  EXPECT_EQ(match.landmark_of(0), kNothing);
  EXPECT_FALSE(match.is_ambiguous(0));
}

TEST(GreedyMatch, DoesNotDependOnTheOrderOfPairs) {
  const std::vector<ScoredPair> pairs{{0, 0, 4.0}, {0, 1, 4.0}, {1, 0, 4.0}, {1, 1, 4.0}};
  const auto forward = solved(pairs, 2, 2);
  const auto backward = solved({pairs.rbegin(), pairs.rend()}, 2, 2);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(forward.landmark_of(i), backward.landmark_of(i));
}

TEST(GreedyMatch, AnObservationBetweenTwoFreeLandmarksIsAmbiguous) {
  EXPECT_TRUE(solved({{0, 0, 8.0}, {0, 1, 6.0}}, 1, 2).is_ambiguous(0));
  EXPECT_FALSE(solved({{0, 0, 8.0}, {0, 1, 4.0}}, 1, 2).is_ambiguous(0));
}

TEST(GreedyMatch, TwoObservationsOfOneLandmarkAreAmbiguous) {
  const auto near = solved({{0, 0, 8.0}, {1, 0, 6.0}}, 2, 1);
  EXPECT_TRUE(near.is_ambiguous(0));
  EXPECT_TRUE(near.is_ambiguous(1));
  const auto far = solved({{0, 0, 8.0}, {1, 0, 2.0}}, 2, 1);
  EXPECT_FALSE(far.is_ambiguous(0));
  EXPECT_FALSE(far.is_ambiguous(1));
}

TEST(GreedyMatch, AnExchangeCountsWithBothItsSides) {
  // Each would rather be what it is by 2; both together would lose 4.
  const auto match = solved({{0, 0, 8.0}, {0, 1, 6.0}, {1, 1, 8.0}, {1, 0, 6.0}}, 2, 2);
  EXPECT_FALSE(match.is_ambiguous(0));
  EXPECT_FALSE(match.is_ambiguous(1));
  const auto close = solved({{0, 0, 8.0}, {0, 1, 7.0}, {1, 1, 8.0}, {1, 0, 7.0}}, 2, 2);
  EXPECT_TRUE(close.is_ambiguous(0));
  EXPECT_TRUE(close.is_ambiguous(1));
}

TEST(GreedyMatch, LeavesOutWhatIsNotANumber) {
  const auto match = solved({{0, 0, std::numeric_limits<double>::quiet_NaN()}, {0, 1, 1.0}}, 1, 2);
  EXPECT_EQ(match.landmark_of(0), 1);
}

}  // namespace
}  // namespace waymark
