#include "waymark/smooth/calibration_file.hpp"

#include <cmath>

#include <fmt/format.h>

#include "waymark/core/angle.hpp"

namespace waymark::smooth {

CalibrationEstimate calibration_of(const Gaussian<3>& odometry) {
  CalibrationEstimate estimate;
  estimate.mean.head<3>() = odometry.mean;
  estimate.sigmas.head<3>() = odometry.covariance.diagonal().cwiseSqrt();
  return estimate;
}

std::vector<CalibratedKey> calibrated_keys(const CalibrationEstimate& estimate, const Config& config) {
  std::vector<CalibratedKey> keys;
  // `unit`: of the key, per unit of the deviation.
  const auto add = [&](const char* key, CalibrationIndex index, double before, double unit) {
    const double sigma = estimate.sigmas[index];
    if (sigma > 0.0) keys.push_back({key, before + unit * estimate.mean[index], std::abs(unit) * sigma});
  };
  const OdometryOptions& odometry = config.odometry;
  const LandmarkSensor& sensor = config.sensor;
  add("motion.speed_scale", kSpeedScale, odometry.speed_scale, odometry.speed_scale);
  add("motion.turn_scale", kTurnScale, odometry.turn_scale, odometry.turn_scale);
  add("sensor.range_scale", kRangeScale, sensor.range_scale, sensor.range_scale);
  add("sensor.range_offset_m", kRangeOffset, sensor.range_offset_m, sensor.range_scale);
  add("sensor.yaw_deg", kBearingOffset, sensor.yaw_deg, to_degrees(-1.0));
  return keys;
}

std::string calibration_yaml(const CalibrationEstimate& estimate, const Config& config) {
  std::string yaml = "# What the log says about the sensors; for --config.\n";
  for (const auto& [key, value, sigma] : calibrated_keys(estimate, config))
    yaml += fmt::format("{}: {:.6g}  # +- {:.2g}\n", key, value, sigma);
  if (const double sigma = estimate.sigmas[kTurnBias]; sigma > 0.0)
    yaml += fmt::format(
        "# While the robot moved, its odometry turned {:.4f} +- {:.4f} degrees per second less.\n",
        to_degrees(estimate.mean[kTurnBias]), to_degrees(sigma));
  if (const double track_m = config.odometry.wheels.track_m; track_m > 0.0)
    yaml += fmt::format("# Scales as a track of the wheels: {:.4f} m instead of {:.4f} m.\n",
                        track_m * (1.0 + estimate.mean[kSpeedScale]) / (1.0 + estimate.mean[kTurnScale]),
                        track_m);
  return yaml;
}

}  // namespace waymark::smooth
