#include "waymark/smooth/calibration_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::smooth {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(CalibrationYaml, IsAConfigThatPutsItInForce) {
  CalibrationEstimate estimate;
  estimate.mean << 0.1, -0.2, 0.0, 0.05, 0.2, 0.01;
  estimate.sigmas << 0.01, 0.01, 0.0, 0.01, 0.01, 0.0;
  Config config;
  config.odometry.speed_scale = 1.1;
  config.sensor.range_scale = 2.0;
  config.sensor.range_offset_m = 0.5;
  Config calibrated = config;
  Schema schema = describe(calibrated);
  ASSERT_TRUE(schema.load_text(calibration_yaml(estimate, config), "calibration.yaml").ok());
  EXPECT_NEAR(calibrated.odometry.speed_scale, 1.21, 1e-5);
  EXPECT_NEAR(calibrated.odometry.turn_scale, 0.8, 1e-5);
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
  Gaussian<3> odometry{{0.0, -0.2, 0.0}, 1e-4 * Eigen::Matrix3d::Identity()};
  EXPECT_THAT(calibration_yaml(calibration_of(odometry), config), HasSubstr("0.2500 m instead of 0.2000 m"));
}

}  // namespace
}  // namespace waymark::smooth
