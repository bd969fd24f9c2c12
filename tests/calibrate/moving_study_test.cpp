#include "workbench/calibrate/moving_study.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

namespace waymark::calibrate {
namespace {

using testing::HasSubstr;

MovingStudy study(const std::string& input, std::vector<std::string> settings) {
  auto result = study_moving(input, {{}, std::move(settings), {}});
  EXPECT_TRUE(result.ok()) << result.error().message;
  return *std::move(result);
}

const smooth::CalibratedKey* find(const MovingStudy& study, const std::string& key) {
  const auto found =
      std::ranges::find(study.findings, key, [](const CalibrationFinding& each) { return each.found.key; });
  return found == study.findings.end() ? nullptr : &found->found;
}

/// Starts from noise three times off and from a delay that is not there; 12 seeds, of which chi-square with
/// 12 degrees of freedom is between 1.9 and 34 in 99.9 % of all cases.
TEST(StudyMoving, FindsNoiseAndDelayOfASimulatedSensorAsSurelyAsItSays) {
  constexpr int kSeeds = 12;
  double bearing_chi2 = 0.0, delay_chi2 = 0.0, range_m = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const MovingStudy found = study("sim:study", {"sensor.range_sigma_m=0.15", "sensor.bearing_sigma_deg=0.5",
                                                  "sensor.delay_s=0.1", "seed=" + std::to_string(seed)});
    const auto* bearing = find(found, "sensor.bearing_sigma_deg");
    const auto* delay = find(found, "sensor.delay_s");
    bearing_chi2 += std::pow((bearing->value - 1.5) / bearing->sigma, 2);
    delay_chi2 += std::pow(delay->value / delay->sigma, 2);
    EXPECT_LT(delay->sigma, 0.02);
    const NoiseBin& middle = found.noise.ranges[found.noise.ranges.size() / 2];
    range_m += (found.noise.range->sigma_m.value + found.noise.range->sigma_ratio.value * middle.at) / kSeeds;
  }
  EXPECT_GT(bearing_chi2, 1.9);
  EXPECT_LT(bearing_chi2, 34.0);
  EXPECT_GT(delay_chi2, 1.9);
  EXPECT_LT(delay_chi2, 34.0);
  // By its own account some 3 % per run.
  EXPECT_NEAR(range_m, 0.05, 0.05 * 4.0 * 0.03 / std::sqrt(kSeeds));
}

TEST(StudyMoving, FindsHowMuchTheOdometryErrs) {
  // Four times the variance of wheels and of slip in turns.
  const MovingStudy found =
      study("sim:study", {"motion.wheel_var_m2_per_m=1.16e-3", "motion.turn_var_rad2_per_rad=4e-3",
                          "motion.turn_var_rad2_per_m=4e-4"});
  EXPECT_NEAR(found.odometry_noise[2].value, 0.5, 4.0 * found.odometry_noise[2].sigma);
  EXPECT_LT(found.odometry_noise[2].sigma, 0.05);
  EXPECT_THAT(found.notes, testing::Contains(HasSubstr("the noise of the odometry is")));
}

TEST(StudyMoving, OfACameraFindsPixelsAndShakingThatIsMoreThanAssumed) {
  const auto of_room = [](const char* shaking) {
    return study("sim:marker-room",
                 {"sim.laps=1", "sim.image_rate_hz=6", "markers.side_sigma_px=0.2", shaking});
  };
  const MovingStudy found = of_room("camera.jitter_deg=0.1");
  const auto* pixels = find(found, "markers.side_sigma_px");
  ASSERT_NE(pixels, nullptr);
  EXPECT_NEAR(pixels->value, 0.08, 4.0 * pixels->sigma);
  EXPECT_LT(pixels->sigma, 0.01);
  EXPECT_TRUE(find(found, "camera.jitter_deg")->is_unobservable);
  EXPECT_EQ(find(found, "camera.jitter_deg")->value, 0.1);
  EXPECT_THAT(found.notes, testing::Contains(HasSubstr("camera.jitter_deg was not changed")));
  EXPECT_EQ(find(found, "sensor.range_sigma_m"), nullptr);
  Config config;
  Schema schema = describe(config);
  ASSERT_TRUE(schema.load_text(to_yaml(found), "calibration.yaml").ok());
  EXPECT_NEAR(config.markers.side_sigma_px, pixels->value, 1e-5);
  EXPECT_GT(find(of_room("camera.jitter_deg=1e-5"), "camera.jitter_deg")->value, 1e-4);
}

TEST(StudyMoving, SaysWhereNothingTellsTheDelay) {
  const MovingStudy found =
      study("sim:square", {"sim.laps=1", "sim.speed_mps=0.3", "smooth.delay_sigma_s=0.001"});
  ASSERT_NE(find(found, "sensor.delay_s"), nullptr);
  EXPECT_TRUE(find(found, "sensor.delay_s")->is_unobservable);
  EXPECT_THAT(found.notes, testing::Contains(HasSubstr("sensor.delay_s is not observable")));
}

TEST(StudyMoving, SaysWhatTheLogLacks) {
  const auto blind = study_moving("sim:square", {{}, {"sim.landmarks=0"}, {}});
  ASSERT_FALSE(blind.ok());
  EXPECT_THAT(blind.error().message, HasSubstr("no landmark"));
}

}  // namespace
}  // namespace waymark::calibrate
