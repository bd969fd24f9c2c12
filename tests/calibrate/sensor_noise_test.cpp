#include "workbench/calibrate/sensor_noise.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"

namespace waymark::calibrate {
namespace {

TEST(FitRangeNoise, FindsALineAndNothingNegative) {
  std::vector<NoiseBin> bins;
  for (int i = 1; i <= 5; ++i) bins.push_back({1.0 * i, 100, 0.0, {0.02 + 0.03 * i, 0.001}});
  const auto line = fit_range_noise(bins);
  EXPECT_NEAR(line->sigma_m.value, 0.02, 1e-12);
  EXPECT_NEAR(line->sigma_ratio.value, 0.03, 1e-12);
  for (NoiseBin& bin : bins) bin.sigma = {0.2 - 0.01 * bin.at, 0.01 * (0.2 - 0.01 * bin.at)};
  EXPECT_EQ(fit_range_noise(bins)->sigma_ratio.value, 0.0);
  EXPECT_NEAR(fit_range_noise(bins)->sigma_m.value, 0.17, 1e-9);
  EXPECT_FALSE(fit_range_noise({}).has_value());
}

/// Errors of which an estimate followed a known part, with variances stated four times too large.
TEST(NoiseOf, CountsWhatWasNotFollowed) {
  RandomStream random(1, StreamPurpose::kWorld);
  constexpr int kCount = 4000;
  std::vector<smooth::SmoothedObservation> observations;
  for (int i = 0; i < kCount; ++i) {
    const double range_m = random.uniform(1.0, 5.0);
    const double sigma_m = 0.02 + 0.01 * range_m;
    const Eigen::Vector2d variance(sigma_m * sigma_m, 0.03 * 0.03);
    const Eigen::Vector2d left(0.8 * sigma_m * random.normal(), 0.6 * 0.03 * random.normal());
    const Eigen::Vector2d followed(0.36, 0.64);
    observations.push_back({RangeBearing{range_m, random.uniform(-1.0, 1.0)},
                            {left, 4.0 * variance.cwiseProduct(followed), 4.0 * variance}});
  }
  observations[7].postfit.residual[0] = 3.0;
  const SensorNoise noise = noise_of(observations);
  EXPECT_GE(noise.outliers, 1);
  EXPECT_NEAR(noise.range->sigma_m.value, 0.02, 4.0 * noise.range->sigma_m.sigma);
  EXPECT_NEAR(noise.range->sigma_ratio.value, 0.01, 4.0 * noise.range->sigma_ratio.sigma);
  EXPECT_LT(noise.range->sigma_ratio.sigma, 0.002);
  EXPECT_NEAR(noise.bearing_sigma_rad->value, 0.03, 4.0 * noise.bearing_sigma_rad->sigma);
  EXPECT_NEAR(noise.bearing_variance.value, 0.25, 0.25 * 4.0 * std::sqrt(2.0 / (0.36 * kCount)));
  EXPECT_NEAR(noise.bearing_variance.redundancy, 0.36 * kCount, 0.01 * kCount);
}

TEST(FitRangeNoise, LeavesOutASlopeThatMayBeChance) {
  std::vector<NoiseBin> bins;
  for (int i = 1; i <= 5; ++i) {
    const double sigma_m = 0.05 + 0.001 * i;
    bins.push_back({1.0 * i, 100, 0.0, {sigma_m, 0.1 * sigma_m}});
  }
  EXPECT_EQ(fit_range_noise(bins)->sigma_ratio.value, 0.0);
  EXPECT_NEAR(fit_range_noise(bins)->sigma_m.value, 0.053, 1e-9);
}

TEST(OdometryVarianceOf, IsAgainstWhatWasStated) {
  RandomStream random(2, StreamPurpose::kWorld);
  constexpr int kCount = 3000;
  const Eigen::Vector3d larger(2.0, 1.0, 0.5);
  std::vector<smooth::IntervalResidual> intervals;
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector3d stated(1e-4, 4e-4, 9e-4);
    smooth::IntervalResidual interval{.followed = 0.5 * stated, .stated = stated};
    for (Eigen::Index k = 0; k < 3; ++k)
      interval.residual[k] = larger[k] * std::sqrt(0.5 * stated[k]) * random.normal();
    intervals.push_back(interval);
  }
  const auto factors = odometry_variance_of(intervals);
  for (std::size_t k = 0; k < 3; ++k) {
    const double variance = larger[static_cast<Eigen::Index>(k)] * larger[static_cast<Eigen::Index>(k)];
    EXPECT_NEAR(factors[k].value, variance, 4.0 * variance * std::sqrt(2.0 / (0.5 * kCount)));
    EXPECT_NEAR(factors[k].redundancy, 0.5 * kCount, 0.02 * kCount);
  }
}

}  // namespace
}  // namespace waymark::calibrate
