#include "waymark/calibrate/sensor_noise.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "waymark/core/angle.hpp"
#include "waymark/core/random.hpp"

namespace waymark::calibrate {
namespace {

using testing::HasSubstr;

TEST(FitRangeNoise, FindsALineAndNothingNegative) {
  std::vector<NoiseBin> bins;
  for (int i = 1; i <= 5; ++i) bins.push_back({1.0 * i, 100, 0.0, {0.02 + 0.03 * i, 0.001}});
  const auto line = fit_range_noise(bins);
  EXPECT_NEAR(line->sigma_m.value, 0.02, 1e-12);
  EXPECT_NEAR(line->sigma_ratio.value, 0.03, 1e-12);
  for (NoiseBin& bin : bins) bin.sigma.value = 0.2 - 0.01 * bin.at;
  EXPECT_EQ(fit_range_noise(bins)->sigma_ratio.value, 0.0);
  EXPECT_NEAR(fit_range_noise(bins)->sigma_m.value, 0.17, 1e-9);
  EXPECT_FALSE(fit_range_noise({}).has_value());
}

/// Errors of which an estimate followed a known part.
TEST(NoiseOf, AddsWhatWasFollowed) {
  RandomStream random(1, StreamPurpose::kWorld);
  constexpr int kCount = 4000;
  std::vector<smooth::SmoothedSighting> sightings;
  for (int i = 0; i < kCount; ++i) {
    const double range_m = random.uniform(1.0, 5.0);
    const double sigma_m = 0.02 + 0.01 * range_m;
    const Eigen::Vector2d left(0.8 * sigma_m * random.normal(), 0.6 * 0.03 * random.normal());
    sightings.push_back({RangeBearing{range_m, random.uniform(-1.0, 1.0)},
                         {left, {0.36 * sigma_m * sigma_m, 0.64 * 0.03 * 0.03}}});
  }
  sightings[7].remainder.residual[0] = 3.0;
  const SensorNoise noise = noise_of(sightings);
  EXPECT_GE(noise.outliers, 1);
  EXPECT_NEAR(noise.range->sigma_m.value, 0.02, 4.0 * noise.range->sigma_m.sigma);
  EXPECT_NEAR(noise.range->sigma_ratio.value, 0.01, 4.0 * noise.range->sigma_ratio.sigma);
  EXPECT_LT(noise.range->sigma_ratio.sigma, 0.002);
  EXPECT_NEAR(noise.bearing_sigma_deg->value, to_degrees(0.03), 4.0 * noise.bearing_sigma_deg->sigma);
}

TEST(CalibrateNoise, FindsTheNoiseOfASimulatedSensor) {
  constexpr int kSeeds = 6;
  double range_m = 0.0, bearing_deg = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const auto noise =
        calibrate_noise("sim:study", {{},
                                      {"sensor.range_sigma_m=0.15", "sensor.bearing_sigma_deg=0.5",
                                       "sensor.delay_s=0.1", "seed=" + std::to_string(seed)},
                                      {}});
    ASSERT_TRUE(noise.ok()) << noise.error().message;
    EXPECT_TRUE(noise->settled);
    const NoiseBin& middle = noise->ranges[noise->ranges.size() / 2];
    range_m += (noise->range->sigma_m.value + noise->range->sigma_ratio.value * middle.at) / kSeeds;
    bearing_deg += noise->bearing_sigma_deg->value / kSeeds;
  }
  // By its own account some 1.3 % per run; and what 4 sigma leave out is less than a tenth of a percent.
  EXPECT_NEAR(range_m, 0.05, 0.05 * 4.0 * 0.013 / std::sqrt(kSeeds));
  EXPECT_NEAR(bearing_deg, 1.5, 1.5 * 4.0 * 0.013 / std::sqrt(kSeeds));
}

TEST(CalibrateNoise, SaysWhatTheLogLacks) {
  const auto blind = calibrate_noise("sim:square", {{}, {"sim.landmarks=0"}, {}});
  ASSERT_FALSE(blind.ok());
  EXPECT_THAT(blind.error().message, HasSubstr("no landmark"));
}

}  // namespace
}  // namespace waymark::calibrate
