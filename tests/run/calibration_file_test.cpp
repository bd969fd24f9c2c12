#include "workbench/run/calibration_file.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "waymark/core/angle.hpp"

#include "workbench/run/recording.hpp"

namespace waymark::smooth {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

TEST(CalibrationYaml, IsAConfigThatPutsItInForce) {
  CalibrationEstimate estimate;
  estimate.mean.head<6>() << 0.1, -0.2, to_radians(0.3), 0.05, 0.2, 0.01;
  estimate.sigmas.head<6>() << 0.01, 0.01, 0.01, 0.01, 0.01, 0.0;
  Config config;
  config.odometry.speed_scale = 1.1;
  config.odometry.turn_bias_degps = 0.5;
  config.sensor.range_scale = 2.0;
  config.sensor.range_offset_m = 0.5;
  Config calibrated = config;
  Schema schema = describe(calibrated);
  ASSERT_TRUE(schema.load_text(calibration_yaml(estimate, config), "calibration.yaml").ok());
  EXPECT_NEAR(calibrated.odometry.speed_scale, 1.21, 1e-5);
  EXPECT_NEAR(calibrated.odometry.turn_scale, 0.8, 1e-5);
  EXPECT_NEAR(calibrated.odometry.turn_bias_degps, 0.8 * 0.5 + 0.3, 1e-5);
  // The range that was reported for 3 m is read as 3 m.
  const double reported_m = 2.0 * (1.05 * 3.0 + 0.2) + 0.5;
  const auto range = std::get<Range>(rectify(calibrated.sensor, Range{reported_m}));
  EXPECT_NEAR(range.range_m, 3.0, 1e-4);
  EXPECT_EQ(calibrated.sensor.yaw_deg, config.sensor.yaw_deg) << "was not estimated";
}

TEST(CalibrationYaml, SaysWhatTheScalesMeanForTwoWheels) {
  Config config;
  EXPECT_THAT(calibration_yaml({}, config), Not(HasSubstr("track")));
  config.odometry.wheels.track_m = 0.2;
  CalibrationEstimate estimate;
  estimate.mean[kTurnScale] = -0.2;
  estimate.sigmas[kTurnScale] = 0.01;
  EXPECT_THAT(calibration_yaml(estimate, config), HasSubstr("0.2500 m instead of 0.2000 m"));
  config.odometry.speed_scale = 1.1;
  EXPECT_THAT(calibration_yaml(estimate, config), HasSubstr("0.2750 m instead of 0.2000 m"));
}

TEST(CalibrationYaml, SaysWhatTheLogDoesNotTell) {
  CalibrationEstimate estimate;
  estimate.sigmas.head<6>() << 0.01, 0.1, 0.0, 0.0, 0.0, 0.0;
  estimate.prior_sigmas.head<6>() << 0.1, 0.1, 0.0, 0.0, 0.0, 0.0;
  const std::string yaml = calibration_yaml(estimate, {});
  EXPECT_THAT(yaml, HasSubstr("motion.speed_scale: 1  # +- 0.01\n"));
  EXPECT_THAT(yaml, HasSubstr("motion.turn_scale: 1  # +- 0.1, prior: not observable in this log\n"));
}

struct CalibratedRun {
  Config config;
  CalibrationEstimate estimate;
  std::vector<std::string> notes;
};

CalibratedRun calibrate_live(std::vector<std::string> assignments, const std::string& calibration = {}) {
  // Wheels that are measured badly would count as turning less.
  assignments.insert(assignments.end(), {"sim.laps=1", "ekf.calibrate_odometry=true",
                                         "sim.wheel_var_m2_per_m=3e-6", "motion.wheel_var_m2_per_m=3e-6"});
  auto input = open_input("sim:study", {{}, assignments});
  EXPECT_TRUE(input.ok()) << input.error().message;
  Schema schema = describe(input->config);
  EXPECT_TRUE(schema.load_text(calibration, "calibration.yaml").ok());
  const auto recording = record(*input->source, input->config);
  EXPECT_TRUE(recording.ok()) << recording.error().message;
  return {input->config, *recording->filter->calibration(), recording->notes};
}

/// What a filter finds out is put in force by --config, and the next run finds nothing more.
TEST(CalibrationYaml, OfAFilterMakesTheNextRunRight) {
  const CalibratedRun before =
      calibrate_live({"motion.speed_scale=0.9", "motion.turn_scale=1.1", "sensor.shared_range_sigma_m=0.2",
                      "sensor.range_offset_m=0.3"});
  const CalibratedRun after =
      calibrate_live({"sensor.shared_range_sigma_m=0.2"}, calibration_yaml(before.estimate, before.config));
  for (const CalibrationIndex index : {kSpeedScale, kTurnScale, kRangeOffset}) {
    EXPECT_GT(std::abs(before.estimate.mean[index]), 3.0 * before.estimate.sigmas[index]) << index;
    EXPECT_LT(std::abs(after.estimate.mean[index]), 3.0 * after.estimate.sigmas[index]) << index;
  }
  EXPECT_NEAR(after.config.odometry.speed_scale, 1.0, 0.03);
  EXPECT_NEAR(after.config.odometry.turn_scale, 1.0, 0.06);
  EXPECT_NEAR(after.config.sensor.range_offset_m, 0.0, 0.1);
}

TEST(CalibrationYaml, DistancesAreNotCalibratedAgainstRangesOfUnknownScale) {
  const CalibratedRun run = calibrate_live({"sensor.shared_range_sigma_ratio=0.1"});
  EXPECT_FALSE(run.estimate.is_estimated(kSpeedScale));
  EXPECT_TRUE(run.estimate.is_estimated(kTurnScale));
  EXPECT_TRUE(run.estimate.is_estimated(kRangeScale));
  EXPECT_THAT(run.notes, Contains(HasSubstr("motion.speed_scale was not estimated")));
}

}  // namespace
}  // namespace waymark::smooth
