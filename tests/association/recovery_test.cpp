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

const Innovation kGated{.outcome = Outcome::kGated};

TEST(Recovery, AScanThatIsHalfAcceptedIsNotMostlyGated) {
  std::vector<Innovation> half(12, {.outcome = Outcome::kMatched});
  for (std::size_t i = 6; i < half.size(); ++i) half[i].outcome = Outcome::kGated;
  EXPECT_FALSE(is_mostly_gated(half));
  half.front().outcome = Outcome::kGated;
  EXPECT_TRUE(is_mostly_gated(half));
  EXPECT_TRUE(is_mostly_gated(scan_of({Outcome::kGated, Outcome::kAdded, Outcome::kUnusable})));
}

TEST(Recovery, InflatesUntilHalfOfTheScanIsBelieved) {
  std::vector<Innovation> scan(5, kGated);
  std::vector<double> sigmas;
  inflate_until_accepted(scan, [&](const Motion& added_motion) {
    EXPECT_TRUE(added_motion.covariance.isDiagonal());
    EXPECT_EQ(added_motion.increment, Pose2{});
    sigmas.push_back(std::sqrt(added_motion.covariance(0, 0)));
    scan[sigmas.size() - 1].outcome = Outcome::kMatched;
  });
  ASSERT_EQ(sigmas.size(), 3U);
  EXPECT_DOUBLE_EQ(sigmas[0], 0.02);
  EXPECT_DOUBLE_EQ(sigmas[1], 0.04);
  EXPECT_DOUBLE_EQ(sigmas[2], 0.08);
}

TEST(Recovery, InflationIsBounded) {
  const std::vector<Innovation> scan(5, kGated);
  double variance = 0.0;
  inflate_until_accepted(scan,
                         [&](const Motion& added_motion) { variance += added_motion.covariance(2, 2); });
  EXPECT_GT(std::sqrt(variance), 2.0);
  EXPECT_LT(std::sqrt(variance), 4.0);
}

}  // namespace
}  // namespace waymark
