#include "workbench/run/calibration_file.hpp"

#include <cmath>

#include <fmt/format.h>

#include "waymark/core/angle.hpp"

namespace waymark::smooth {

std::vector<CalibratedKey> calibrated_keys(const CalibrationEstimate& estimate, const Config& config) {
  std::vector<CalibratedKey> keys;
  // `unit`: of the key, per unit of the deviation.
  const auto add = [&](const char* key, CalibrationIndex index, double before, double unit) {
    if (!estimate.is_estimated(index)) return;
    keys.push_back({key, before + unit * estimate.mean[index], std::abs(unit) * estimate.sigmas[index],
                    estimate.is_unobservable(index)});
  };
  const OdometryOptions& odometry = config.odometry;
  const LandmarkSensor& sensor = config.sensor;
  add("motion.speed_scale", kSpeedScale, odometry.speed_scale, odometry.speed_scale);
  add("motion.turn_scale", kTurnScale, odometry.turn_scale, odometry.turn_scale);
  add("motion.turn_bias_degps", kTurnBias, (1.0 + estimate.mean[kTurnScale]) * odometry.turn_bias_degps,
      to_degrees(1.0));
  add("sensor.range_scale", kRangeScale, sensor.range_scale, sensor.range_scale);
  add("sensor.range_offset_m", kRangeOffset, sensor.range_offset_m, sensor.range_scale);
  // The mount of a camera that finds markers is what decides where the sensor is.
  const bool is_camera = config.observe == Observe::kMarkers;
  add(is_camera ? "camera.mount_x_m" : "sensor.x_m", kMountX, sensor.x_m, 1.0);
  add(is_camera ? "camera.mount_y_m" : "sensor.y_m", kMountY, sensor.y_m, 1.0);
  add(is_camera ? "camera.mount_yaw_deg" : "sensor.yaw_deg", kBearingOffset, sensor.yaw_deg,
      to_degrees(-1.0));
  add("sensor.delay_s", kDelay, sensor.delay_s, 1.0);
  return keys;
}

std::string calibration_yaml(std::span<const CalibratedKey> keys) {
  std::string yaml = "# Calibration of odometry and sensors from a log; use it with --config.\n";
  for (const auto& [key, value, sigma, is_unobservable] : keys)
    yaml +=
        fmt::format("{}: {:.6g}{}{}\n", key, value, sigma > 0.0 ? fmt::format("  # +- {:.2g}", sigma) : "",
                    is_unobservable ? ", prior: not observable in this log" : "");
  return yaml;
}

std::string calibration_yaml(const CalibrationEstimate& estimate, const Config& config) {
  std::string yaml = calibration_yaml(calibrated_keys(estimate, config));
  const OdometryOptions& odometry = config.odometry;
  if (const double track_m = odometry.wheels.track_m; estimate.is_estimated(kTurnScale) && track_m > 0.0) {
    const double speed_scale = odometry.speed_scale * (1.0 + estimate.mean[kSpeedScale]);
    const double turn_scale = odometry.turn_scale * (1.0 + estimate.mean[kTurnScale]);
    yaml += fmt::format("# The same scales as a wheel track: {:.4f} m instead of {:.4f} m.\n",
                        track_m * speed_scale / turn_scale, track_m);
  }
  return yaml;
}

}  // namespace waymark::smooth
