#include "waymark/fastslam/information_weight.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace waymark::fastslam {
namespace {

constexpr double kFar_m = std::numeric_limits<double>::infinity();

TEST(InformationWeight, GrowsWithTheWaySinceTheLandmarkWasSeen) {
  const InformationWeight weight(2.0);
  EXPECT_EQ(weight.power(0.0), 0.0);
  EXPECT_NEAR(weight.power(2.0), 1.0 - std::exp(-1.0), 1e-15);
  EXPECT_EQ(weight.power(kFar_m), 1.0);
}

TEST(InformationWeight, WithoutAWayEveryObservationCountsInFull) {
  EXPECT_EQ(InformationWeight(0.0).power(0.0), 1.0);
}

/// The variance of the mean of n errors of unit variance, each correlated by rho with the one before, is that
/// of n independent ones times (1 + rho) / (1 - rho), for many.
TEST(InformationWeight, ErrorsThatLastCountAsTheMeanOfARunOfThemSays) {
  for (const double travelled_m : {0.05, 0.3, 2.0}) {
    const double rho = std::exp(-travelled_m / 0.3);
    EXPECT_NEAR(bias_variance_factor(travelled_m, 0.3), (1.0 + rho) / (1.0 - rho), 1e-9);
  }
  EXPECT_EQ(bias_variance_factor(kFar_m, 0.3), 1.0);
  EXPECT_EQ(bias_variance_factor(0.0, 0.3), bias_variance_factor(kMinTravelled_m, 0.3));
}

}  // namespace
}  // namespace waymark::fastslam
