#include "workbench/run/check_units.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "workbench/run/quantile.hpp"

namespace waymark {
namespace {

using Line = std::optional<std::string>;

std::optional<double> range_of(const Measurement& value) {
  if (const auto* both = std::get_if<RangeBearing>(&value)) return both->range_m;
  if (const auto* range = std::get_if<Range>(&value)) return range->range_m;
  return std::nullopt;
}

std::optional<double> bearing_of(const Measurement& value) {
  if (const auto* both = std::get_if<RangeBearing>(&value)) return both->bearing_rad;
  if (const auto* bearing = std::get_if<Bearing>(&value)) return bearing->bearing_rad;
  return std::nullopt;
}

template <class Part>
std::vector<double> sizes(const LogSample& sample, Part part) {
  std::vector<double> values;
  for (const auto& observed : sample.observations)
    if (const auto value = part(observed.value); value && std::isfinite(*value))
      values.push_back(std::abs(*value));
  return values;
}

Line check_bearings(const LogSample& sample) {
  const auto bearings_rad = sizes(sample, bearing_of);
  if (quantile(bearings_rad, 0.95) <= 2.0 * kPi) return std::nullopt;
  return fmt::format("bearings up to {:.1f} rad: are they in degrees? bearing_rad has to be in radians",
                     std::ranges::max(bearings_rad));
}

Line check_ranges(const LogSample& sample, const LandmarkSensor& sensor) {
  const auto ranges_m = sizes(sample, range_of);
  const auto refused = std::ranges::count_if(
      ranges_m, [&](double range_m) { return range_m < sensor.min_range_m || range_m > sensor.max_range_m; });
  if (2 * refused <= std::ssize(ranges_m)) return std::nullopt;
  const bool is_far = quantile(ranges_m, 0.5) > sensor.max_range_m;
  return fmt::format(
      "{} of {} ranges, {:.4g} to {:.4g} m, are outside of sensor.min_range_m = {:g} and "
      "sensor.max_range_m = {:g}{}",
      refused, ranges_m.size(), std::ranges::min(ranges_m), std::ranges::max(ranges_m), sensor.min_range_m,
      sensor.max_range_m, is_far ? ": are they in millimetres? range_m has to be in metres" : "");
}

/// Forward and turning, per second.
struct Speed {
  double v_mps;
  double w_radps;
};

Speed speed_of(const Pose2& moved, double dt_s) {
  return {moved.position().norm() / dt_s, std::abs(moved.theta_rad) / dt_s};
}

/// Between two readings of cumulative odometry.
std::optional<Speed> speed_between(const Event& first, const Event& second, const OdometryOptions& options) {
  const double dt_s = to_seconds(second.stamp - first.stamp);
  if (const auto* pose = std::get_if<OdometryPose>(&second.content))
    return speed_of(std::get<OdometryPose>(first.content).T_odom_robot.inverse() * pose->T_odom_robot, dt_s);
  const auto* angles = std::get_if<WheelAngles>(&second.content);
  if (angles == nullptr || !check(options.wheels)) return std::nullopt;
  const auto& before = std::get<WheelAngles>(first.content);
  const ArcStep step =
      wheel_step({angles->left_rad - before.left_rad, angles->right_rad - before.right_rad}, options.wheels);
  return Speed{std::abs(step.distance_m) / dt_s, std::abs(step.turn_rad) / dt_s};
}

/// As told, or over a quarter of a second, which no jitter of stamps falsifies.
std::vector<Speed> speeds_of(const LogSample& sample, const OdometryOptions& options) {
  constexpr double kOver_s = 0.25;
  std::vector<Speed> speeds;
  const Event* before = nullptr;
  for (const Event& event : sample.odometry) {
    if (const auto* told = std::get_if<Velocity>(&event.content)) {
      speeds.push_back({std::abs(told->v_mps), std::abs(told->w_radps)});
    } else if (const auto* steering = std::get_if<Steering>(&event.content)) {
      speeds.push_back({std::abs(steering->v_mps), 0.0});
    } else if (before == nullptr || to_seconds(event.stamp - before->stamp) >= kOver_s) {
      if (before != nullptr)
        if (const auto speed = speed_between(*before, event, options)) speeds.push_back(*speed);
      before = &event;
    }
  }
  return speeds;
}

std::vector<std::string> check_speeds(const LogSample& sample, const OdometryOptions& options) {
  constexpr double kPart = 0.9;
  constexpr double kFast_mps = 30.0;
  constexpr double kFast_radps = 15.0;
  std::vector<double> v_mps;
  std::vector<double> w_radps;
  for (const Speed& speed : speeds_of(sample, options)) {
    v_mps.push_back(speed.v_mps);
    w_radps.push_back(speed.w_radps);
  }
  std::vector<std::string> lines;
  if (const double fast_mps = quantile(v_mps, kPart); fast_mps > kFast_mps)
    lines.push_back(
        fmt::format("the odometry has speeds of {:.0f} m/s: is it in centimetres or millimetres, or "
                    "are wheel angles in ticks or degrees? It has to be in metres and radians",
                    fast_mps));
  if (const double fast_radps = quantile(w_radps, kPart); fast_radps > kFast_radps)
    lines.push_back(
        fmt::format("the odometry turns at {:.0f} rad/s: is it in degrees, or is "
                    "wheels.track_m too small? It has to be in radians",
                    fast_radps));
  return lines;
}

/// By how much stamps that are so far apart are likely too large.
const char* unit_of(double interval_s) {
  if (interval_s >= 1e7) return "nanoseconds";
  return interval_s >= 1e4 ? "microseconds" : "milliseconds";
}

template <class Timed>
double duration_s(const std::vector<Timed>& all) {
  return all.empty() ? 0.0 : to_seconds(all.back().stamp - all.front().stamp);
}

Line check_intervals(const LogSample& sample) {
  constexpr double kSlow_s = 10.0;
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < sample.odometry.size(); ++i)
    intervals_s.push_back(to_seconds(sample.odometry[i].stamp - sample.odometry[i - 1].stamp));
  const double interval_s = quantile(intervals_s, 0.5);
  if (interval_s < kSlow_s) return std::nullopt;
  return fmt::format(
      "the odometry has a reading every {:.4g} s: are stamps in {}? They have to be in seconds", interval_s,
      unit_of(interval_s));
}

Line check_durations(const LogSample& sample) {
  constexpr double kTimes = 100.0;
  const double odometry_s = duration_s(sample.odometry);
  const double observed_s = duration_s(sample.observations);
  const auto [shorter_s, longer_s] = std::minmax(odometry_s, observed_s);
  const bool is_sampled =
      sample.odometry.size() < LogSample::kMost && sample.observations.size() < LogSample::kMost;
  if (!is_sampled || shorter_s <= 0.0 || longer_s < kTimes * shorter_s) return std::nullopt;
  return fmt::format(
      "the odometry lasts {:.4g} s and the observations {:.4g} s: are stamps of one of them in "
      "milliseconds? They have to be in seconds",
      odometry_s, observed_s);
}

}  // namespace

std::vector<std::string> check_units(const LogSample& sample, const Config& config) {
  std::vector<std::string> lines = check_speeds(sample, config.odometry);
  for (auto& line : {check_bearings(sample), check_ranges(sample, config.sensor), check_intervals(sample),
                     check_durations(sample)})
    if (line) lines.push_back(*line);
  return lines;
}

}  // namespace waymark
