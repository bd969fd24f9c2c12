#include "workbench/sim/landmark_sensor.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::sim {
namespace {

// Identities that no landmark bears: so many of them that one is seldom invented twice.
constexpr int kInventedIdentities = 1000;

// A filter must not believe in a sensor that never misses.
constexpr double kDetectionProbabilityMax = 0.99;

std::size_t draw_index(std::size_t count, RandomStream& random) {
  return std::min(count - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(count)));
}

RangeBearing disturbed(const LandmarkSensor& sensor, const RangeBearing& seen, RandomStream& random) {
  const Eigen::Matrix2d R = noise_covariance(sensor, seen);
  const double range_m = seen.range_m + std::sqrt(R(0, 0)) * random.normal();
  return {range_m, wrap_angle(seen.bearing_rad + std::sqrt(R(1, 1)) * random.normal())};
}

Measurement as_measured(SensorKind observe, const RangeBearing& value) {
  switch (observe) {
    case SensorKind::kRange:
      return Range{value.range_m};
    case SensorKind::kBearing:
      return Bearing{value.bearing_rad};
    case SensorKind::kRangeBearing:
      break;
  }
  return value;
}

/// Any identity but the one at `index`; its own where there is no other.
LandmarkId misread(const std::vector<TrueLandmark>& landmarks, std::size_t index, RandomStream& random) {
  const std::size_t count = landmarks.size();
  if (count == 1) return landmarks[index].id;
  return landmarks[(index + 1 + draw_index(count - 1, random)) % count].id;
}

LandmarkId false_identity(const std::vector<TrueLandmark>& landmarks, RandomStream& random) {
  const bool known = random.uniform() < 0.5 && !landmarks.empty();
  if (known) return landmarks[draw_index(landmarks.size(), random)].id;
  const std::size_t number = landmarks.size() + draw_index(kInventedIdentities, random);
  return {LandmarkId::Family::kMarker, static_cast<std::int32_t>(number)};
}

/// Somewhere in the field of view.
RangeBearing false_observation(const SensorOptions& options, RandomStream& random) {
  const double range_m = random.uniform(options.range_min_m, options.range_max_m);
  return {range_m, wrap_angle((random.uniform() - 0.5) * to_radians(options.field_of_view_deg))};
}

}  // namespace

LandmarkSensor model_of(const SensorOptions& options) {
  return {.x_m = options.x_m,
          .y_m = options.y_m,
          .yaw_deg = options.yaw_deg,
          .range_sigma_m = options.range_sigma_m,
          .range_sigma_ratio = options.range_sigma_ratio,
          .bearing_sigma_deg = options.bearing_sigma_deg,
          .min_range_m = options.range_min_m,
          .max_range_m = options.range_max_m,
          .field_of_view_deg = options.field_of_view_deg,
          .detection_probability = std::min(1.0 - options.drop_probability, kDetectionProbabilityMax)};
}

bool is_visible(const SensorOptions& options, const RangeBearing& seen) {
  return seen.range_m >= options.range_min_m && seen.range_m <= options.range_max_m &&
         std::abs(seen.bearing_rad) <= to_radians(options.field_of_view_deg) / 2.0;
}

RangeBearing sight(const Pose2& T_sensor_world, const Eigen::Vector2d& p_world) {
  const Eigen::Vector2d p_sensor = T_sensor_world * p_world;
  return {p_sensor.norm(), std::atan2(p_sensor.y(), p_sensor.x())};
}

Observations scan(const SensorOptions& options, const Pose2& T_world_robot,
                  const std::vector<TrueLandmark>& landmarks, RandomStream& random) {
  const LandmarkSensor sensor = model_of(options);
  const Pose2 T_sensor_world = (T_world_robot * sensor.T_robot_sensor()).inverse();
  Observations seen;
  const auto report = [&](LandmarkId id, const RangeBearing& value) {
    seen.push_back({id, as_measured(options.observe, value), std::nullopt});
  };
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const RangeBearing truth = sight(T_sensor_world, {landmarks[i].x_m, landmarks[i].y_m});
    if (!is_visible(options, truth)) continue;
    const RangeBearing value = disturbed(sensor, truth, random);
    const bool is_dropped = random.uniform() < options.drop_probability || value.range_m <= 0.0;
    const bool is_misread = random.uniform() < options.misread_probability;
    if (is_dropped) continue;
    report(is_misread ? misread(landmarks, i, random) : landmarks[i].id, value);
    if (options.clutter_probability > 0.0 && random.uniform() < options.clutter_probability)
      seen.push_back({std::nullopt, as_measured(options.observe, false_observation(options, random)), {}});
  }
  if (random.uniform() < options.false_probability) {
    const LandmarkId id = false_identity(landmarks, random);
    report(id, false_observation(options, random));
  }
  return seen;
}

}  // namespace waymark::sim
