#include "waymark/fastslam/information_weight.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace waymark::fastslam {
namespace {

constexpr double kFar_m = std::numeric_limits<double>::infinity();

TEST(InformationWeight, GrowsWithTheDistanceSinceTheLandmarkWasSeen) {
  const InformationWeight weight(2.0);
  EXPECT_EQ(weight.power(0.0), 0.0);
  EXPECT_NEAR(weight.power(2.0), 1.0 - std::exp(-1.0), 1e-15);
  EXPECT_EQ(weight.power(kFar_m), 1.0);
}

TEST(InformationWeight, WithoutADistanceEveryObservationCountsInFull) {
  EXPECT_EQ(InformationWeight(0.0).power(0.0), 1.0);
}

}  // namespace
}  // namespace waymark::fastslam
