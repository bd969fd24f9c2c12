#include "waymark/fastslam/sensor_model.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "known_map.hpp"

namespace waymark::fastslam {
namespace {

constexpr double kFirst_m = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(SensorModel, OnlyFiniteNumbersWithNoiseAreUsable) {
  EXPECT_TRUE(is_usable(test::range_bearing(2.0, 0.1)));
  EXPECT_TRUE(is_usable(test::range_alone(2.0)));
  EXPECT_FALSE(is_usable(test::range_bearing(kNan, 0.1)));
  EXPECT_FALSE(is_usable(test::range_bearing(1e200, 0.1)));
  EXPECT_FALSE(is_usable(test::range_alone(0.0)));
  Observation observation = test::range_bearing(2.0, 0.1);
  observation.covariance = Eigen::Matrix2d(Eigen::Matrix2d::Ones());
  EXPECT_FALSE(is_usable(observation));
  observation.covariance.reset();
  EXPECT_FALSE(is_usable(observation));
  EXPECT_FALSE(is_usable({{}, Pixel{1.0, 1.0}, Eigen::Matrix2d(Eigen::Matrix2d::Identity())}));
}

TEST(SensorModel, CountsNoiseWithItsInflationAndTheLastingErrors) {
  LandmarkSensor sensor;
  sensor.errors.bias_range_sigma_ratio = 0.02;
  sensor.errors.bias_bearing_sigma_deg = to_degrees(0.01);
  const SensorModel model(sensor, 2.0);
  const auto first = model.seen(test::range_bearing(5.0, 0.0), kFirst_m, {});
  EXPECT_NEAR(first.R_rr, 4.0 * 0.01 + 0.1 * 0.1, 1e-7);
  EXPECT_NEAR(first.R_bb, 4.0 * 0.0004 + 0.01 * 0.01, 1e-9);
  EXPECT_GT(model.seen(test::range_bearing(5.0, 0.0), 0.1, {}).R_rr, first.R_rr);
  EXPECT_EQ(model.seen(test::range_alone(5.0), kFirst_m, {}).R_bb, 0.0F);
}

TEST(SensorModel, DirectionsAreThoseOfTheRobot) {
  LandmarkSensor sensor;
  sensor.yaw_deg = 90.0;
  const auto seen = SensorModel(sensor, 1.0).seen(test::range_bearing(5.0, 0.2), kFirst_m, {});
  EXPECT_NEAR(seen.cos_bearing, -std::sin(0.2), 1e-6);
  EXPECT_NEAR(seen.sin_bearing, std::cos(0.2), 1e-6);
}

TEST(SensorModel, NoSensorIsSharperThanAFloatCanTell) {
  Observation sharp = test::range_bearing(100.0, 0.0);
  sharp.covariance = Eigen::Matrix2d(1e-30 * Eigen::Matrix2d::Identity());
  const auto seen = SensorModel({}, 1.0).seen(sharp, kFirst_m, {});
  EXPECT_NEAR(std::sqrt(seen.R_rr), 1e-4, 1e-8);
  EXPECT_NEAR(std::sqrt(seen.R_bb), 1e-6, 1e-10);
}

/// The variance of the mean of n errors of unit variance, each correlated by rho with the one before, is that
/// of n independent ones times (1 + rho) / (1 - rho), for many.
TEST(BiasVarianceFactor, IsThatOfTheMeanOfManyCorrelatedErrors) {
  for (const double travelled_m : {0.05, 0.3, 2.0}) {
    const double rho = std::exp(-travelled_m / 0.3);
    EXPECT_NEAR(bias_variance_factor(travelled_m, 0.3), (1.0 + rho) / (1.0 - rho), 1e-9);
  }
  EXPECT_EQ(bias_variance_factor(kFirst_m, 0.3), 1.0);
  EXPECT_EQ(bias_variance_factor(0.0, 0.3), bias_variance_factor(kMinTravelled_m, 0.3));
}

}  // namespace
}  // namespace waymark::fastslam
