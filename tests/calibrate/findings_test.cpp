#include "workbench/calibrate/findings.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "waymark/core/angle.hpp"

namespace waymark::calibrate {
namespace {

/// Everything was estimated, as surely as this.
smooth::Smoothed smoothed(double sigma, double prior_sigma) {
  smooth::Smoothed result;
  CalibrationEstimate& c = result.calibration;
  c.mean << 0.02, -0.03, 0.001, 0.04, 0.1, 0.02, 0.03, 0.05, -0.06, 0.07;
  c.sigmas.setConstant(sigma);
  c.prior_sigmas.setConstant(prior_sigma);
  result.calibration_covariance.diagonal().setConstant(sigma * sigma);
  return result;
}

Config config() {
  Config config;
  config.odometry.wheels = {0.1, 0.11, 0.4};
  config.odometry.speed_scale = 1.1;
  config.odometry.turn_scale = 0.95;
  config.odometry.turn_bias_degps = 0.2;
  config.sensor.range_scale = 1.2;
  config.sensor.x_m = 0.3;
  config.sensor.yaw_deg = 10.0;
  return config;
}

const CalibrationFinding* find(const std::vector<CalibrationFinding>& list, const std::string& key) {
  const auto found = std::ranges::find(list, key, [](const CalibrationFinding& f) { return f.found.key; });
  return found == list.end() ? nullptr : &*found;
}

/// With what was found in force, what leads back to the config before is the way there, backwards.
TEST(Findings, InForceTheyDifferFromBeforeByWhatWasEstimated) {
  for (const OdometryKind kind : {OdometryKind::kWheels, OdometryKind::kVelocity}) {
    const Config before = config();
    const auto run = smoothed(0.01, 0.1);
    Config after = before;
    Schema schema = describe(after);
    for (const auto& key : keys_of(findings(run, before, before, kind)))
      ASSERT_TRUE(schema.set(key.key, std::to_string(key.value), "test").ok()) << key.key;
    const Calibration found = deviation(before, after, kind);
    Calibration expected = run.calibration.mean;
    if (kind == OdometryKind::kVelocity) expected[kTurnPerMetre] = 0.0;  // no key for it
    EXPECT_TRUE(waymark::test::matrix_near(found, expected, 1e-4));
  }
}

TEST(Findings, OfWheelsAreRadiiAndTrack) {
  const auto list = findings(smoothed(0.01, 0.1), config(), config(), OdometryKind::kWheels);
  ASSERT_NE(find(list, "wheels.track_m"), nullptr);
  EXPECT_EQ(find(list, "motion.speed_scale"), nullptr);
  EXPECT_NEAR(find(list, "wheels.track_m")->before, 0.4 * 1.1 / 0.95, 1e-12);
  // track ~ (1 + speed) / (1 + turn), both known to 1 %
  EXPECT_NEAR(find(list, "wheels.track_m")->found.sigma / find(list, "wheels.track_m")->found.value,
              0.01 * std::hypot(1.0 / 1.02, 1.0 / 0.97), 1e-12);
  EXPECT_FALSE(find(list, "right radius / left radius")->is_key);
  EXPECT_FALSE(find(list, "wheels.track_m")->found.is_unobservable);
}

TEST(Findings, SayWhatTheLogDoesNotTell) {
  for (const auto& finding : findings(smoothed(0.099, 0.1), config(), config(), OdometryKind::kWheels))
    EXPECT_TRUE(finding.found.is_unobservable) << finding.found.key;
}

TEST(Findings, OfAMarkerCameraAreItsMount) {
  Config camera = config();
  camera.observe = Observe::kMarkers;
  camera.camera.mount.x_m = camera.sensor.x_m;
  const auto list = findings(smoothed(0.01, 0.1), camera, camera, OdometryKind::kPose);
  ASSERT_NE(find(list, "camera.mount_x_m"), nullptr);
  EXPECT_NEAR(find(list, "camera.mount_x_m")->found.value, 0.35, 1e-12);
  EXPECT_EQ(find(list, "camera.mount_x_m")->before, 0.3);
  EXPECT_NEAR(find(list, "camera.mount_yaw_deg")->found.value, 10.0 - to_degrees(0.02), 1e-9);
  EXPECT_EQ(find(list, "sensor.x_m"), nullptr);
}

}  // namespace
}  // namespace waymark::calibrate
