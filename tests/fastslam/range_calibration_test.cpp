#include "waymark/fastslam/range_calibration.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace waymark::fastslam {
namespace {

LandmarkSensor sensor_with(double sigma_ratio, double sigma_m) {
  LandmarkSensor sensor;
  sensor.errors.shared_range_sigma_ratio = sigma_ratio;
  sensor.errors.shared_range_sigma_m = sigma_m;
  return sensor;
}

constexpr int kFactors = 4000;

TEST(RangeCalibration, EstimatesNothingUnlessThereIsSomethingToFindOut) {
  ParticleBlocks blocks(10);
  const RangeCalibration none({}, 1, blocks);
  EXPECT_FALSE(none.is_estimated());
  EXPECT_EQ(none.columns().offset, nullptr);
  EXPECT_TRUE(RangeCalibration(sensor_with(0.0, 0.1), 1, blocks).is_estimated());
}

TEST(RangeCalibration, BeginsAsUnsureAsTheSensorSays) {
  ParticleBlocks blocks(kFactors);
  const RangeCalibration calibration(sensor_with(0.1, 0.5), 1, blocks);
  const std::vector<double> weights(kFactors, 1.0 / kFactors);
  // Within four standard errors.
  EXPECT_NEAR(calibration.scale(weights).mean, 1.0, 4.0 * 0.1 / std::sqrt(kFactors));
  EXPECT_NEAR(calibration.scale(weights).sigma, 0.1, 4.0 * 0.1 / std::sqrt(2.0 * kFactors));
  EXPECT_NEAR(calibration.offset_m(weights).mean, 0.0, 4.0 * 0.5 / std::sqrt(kFactors));
  EXPECT_NEAR(calibration.offset_m(weights).sigma, 0.5, 4.0 * 0.5 / std::sqrt(2.0 * kFactors));
}

TEST(RangeCalibration, FollowsMovesAndAncestors) {
  ParticleBlocks blocks(3);
  RangeCalibration calibration(sensor_with(0.1, 0.5), 1, blocks);
  for (int i = 0; i < 3; ++i) {
    calibration.scale()[i] = 1.0F + static_cast<float>(i);
    calibration.offset_m()[i] = static_cast<float>(i);
  }
  calibration.refresh();
  EXPECT_FLOAT_EQ(calibration.columns().factor[2], 1.0F / 3.0F);
  calibration.replace_by_ancestors(std::vector<std::int32_t>{2, 2, 2});
  EXPECT_FLOAT_EQ(calibration.columns().factor[0], 1.0F / 3.0F);
  EXPECT_FLOAT_EQ(calibration.columns().offset[1], 2.0F);
}

}  // namespace
}  // namespace waymark::fastslam
