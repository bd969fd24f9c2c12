#include "workbench/calibrate/log_calibration.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

namespace waymark::calibrate {
namespace {

using testing::HasSubstr;

LogCalibration calibrate(const std::string& input, std::vector<std::string> settings, Subject subject,
                         const TimeSpan& span = {}) {
  auto result = calibrate_log(input, {{}, std::move(settings), {}}, subject, span);
  EXPECT_TRUE(result.ok()) << result.error().message;
  return *std::move(result);
}

const CalibrationFinding& finding(const LogCalibration& result, const std::string& key) {
  const auto found =
      std::ranges::find(result.findings, key, [](const CalibrationFinding& each) { return each.found.key; });
  EXPECT_NE(found, result.findings.end()) << key;
  return *found;
}

/// Squared errors in units of their stated variance, summed over seeds, by key.
struct Chi2 {
  std::string key;
  double truth;
  double sum = 0.0;
};

// 12 seeds: chi-square with 12 degrees of freedom is between these in 99.9 % of all cases.
constexpr int kSeeds = 12;
constexpr double kLeast = 1.9;
constexpr double kMost = 34.0;

void expect_found(const std::string& input, const std::vector<std::string>& settings, Subject subject,
                  std::vector<Chi2> keys) {
  for (int seed = 1; seed <= kSeeds; ++seed) {
    auto all = settings;
    all.push_back("seed=" + std::to_string(seed));
    const LogCalibration result = calibrate(input, all, subject);
    EXPECT_TRUE(result.settled) << seed;
    for (Chi2& key : keys) {
      const smooth::CalibratedKey& found = finding(result, key.key).found;
      EXPECT_FALSE(found.is_unobservable) << key.key;
      key.sum += std::pow((found.value - key.truth) / found.sigma, 2);
    }
  }
  for (const Chi2& key : keys) {
    EXPECT_GT(key.sum, kLeast) << key.key;
    EXPECT_LT(key.sum, kMost) << key.key;
  }
}

TEST(CalibrateOdometry, FindsWrongWheelsAsSurelyAsItSays) {
  expect_found("sim:study",
               {"wheels.left_radius_m=0.1", "wheels.right_radius_m=0.0995", "wheels.track_m=0.3"},
               Subject::kOdometry,
               {{"wheels.left_radius_m", 0.0975},
                {"wheels.right_radius_m", 0.0975},
                {"wheels.track_m", 0.331},
                {"right radius / left radius", 1.0}});
}

TEST(CalibrateOdometry, FindsWrongScalesOfVelocities) {
  expect_found("sim:study", {"sim.odometry=velocity", "motion.speed_scale=0.93", "motion.turn_scale=1.1"},
               Subject::kOdometry,
               {{"motion.speed_scale", 1.0}, {"motion.turn_scale", 1.0}, {"motion.turn_bias_degps", 0.0}});
}

TEST(CalibrateMount, FindsAWrongMountWithWrongWheels) {
  expect_found(
      "sim:study",
      {"sim.sensor_x_m=0.2", "sim.sensor_y_m=-0.1", "sim.sensor_yaw_deg=4", "sensor.x_m=0", "sensor.y_m=0",
       "sensor.yaw_deg=0", "wheels.track_m=0.35", "wheels.left_radius_m=0.099"},
      Subject::kMount,
      {{"sensor.x_m", 0.2}, {"sensor.y_m", -0.1}, {"sensor.yaw_deg", 4.0}, {"wheels.track_m", 0.331}});
}

TEST(CalibrateOdometry, MakesDeadReckoningDriftLess) {
  const auto result = calibrate("sim:study", {"wheels.track_m=0.3"}, Subject::kOdometry);
  ASSERT_TRUE(result.drift && result.drift_from_truth);
  EXPECT_LT(result.drift->after.final_m, 0.5 * result.drift->before.final_m);
  EXPECT_LT(result.drift_from_truth->after.final_m, 0.5 * result.drift_from_truth->before.final_m);
  // What it wrote makes the next run find nothing more.
  Config config;
  Schema schema = describe(config);
  ASSERT_TRUE(schema.load_text(to_yaml(result), "calibration.yaml").ok());
  EXPECT_NEAR(config.odometry.wheels.track_m, finding(result, "wheels.track_m").found.value, 1e-5);
}

TEST(CalibrateMount, SaysWhatStraightMotionDoesNotShow) {
  // The first side of a square, without a wobble that would be turning.
  const auto result = calibrate("sim:square",
                                {"sim.wheel_var_m2_per_m=1e-9", "sim.slip_turn_var_rad2_per_m=1e-9",
                                 "sim.slip_forward_var_m2_per_m=1e-9", "sim.slip_lateral_var_m2_per_m=1e-9"},
                                Subject::kMount, {0.0, 10.0});
  for (const char* key : {"wheels.track_m", "sensor.x_m", "sensor.y_m"})
    EXPECT_TRUE(finding(result, key).found.is_unobservable) << key;
  EXPECT_FALSE(finding(result, "wheels.left_radius_m").found.is_unobservable);
  EXPECT_THAT(result.notes,
              testing::Contains(testing::AllOf(HasSubstr("not observable in this log"),
                                               HasSubstr("wheels.track_m"), HasSubstr("sensor.x_m"))));
}

TEST(CalibrateOdometry, BearingsDoNotTellTheSizeOfTheWorld) {
  const auto result = calibrate("sim:study", {"observe=bearing", "filter=fastslam"}, Subject::kOdometry);
  EXPECT_THAT(result.notes, testing::Contains(HasSubstr("without ranges of known scale")));
  EXPECT_FALSE(finding(result, "wheels.track_m").found.is_unobservable);
}

TEST(CalibrateOdometry, SaysWhatTheLogLacks) {
  const auto blind = calibrate_log("sim:square", {{}, {"sim.landmarks=0"}, {}}, Subject::kOdometry);
  ASSERT_FALSE(blind.ok());
  EXPECT_THAT(blind.error().message, HasSubstr("no landmark was observed"));
  const auto stopped =
      calibrate_log("sim:square", {}, Subject::kOdometry, {}, [](int, double) { return false; });
  ASSERT_FALSE(stopped.ok());
  EXPECT_EQ(stopped.error().kind, Error::Kind::kFailed);
}

}  // namespace
}  // namespace waymark::calibrate
