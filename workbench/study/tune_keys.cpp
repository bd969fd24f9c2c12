#include "workbench/study/tune_keys.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace waymark::study {
namespace {

constexpr double kMaxFactor = 1000.0;
const double kFirstFactor = std::log(2.0);
// Of a key that may be negative: a third of it, or this.
constexpr double kFirstStep = 0.02;

bool is_of_input(std::string_view name) { return name.starts_with("input.") || name.starts_with("sim."); }

Result<TuneKey> tune_key(const Schema& schema, const std::string& name) {
  if (!schema.has(name)) {
    const auto close = schema.close_keys(name, 3);
    return Error{close.empty()
                     ? fmt::format("--keys: unknown key {}; `waymark config --all` lists all keys", name)
                     : fmt::format("--keys: unknown key {}; close keys: {}", name, fmt::join(close, ", "))};
  }
  const auto limits = schema.limits(name);
  if (!limits)
    return Error{fmt::format("--keys: {} is not a real number; only real numbers can be tuned", name)};
  if (is_of_input(name))
    return Error{
        fmt::format("--keys: {} changes what is in the log; only keys of the estimation can be tuned", name)};
  const double start = std::strtod(schema.value(name).c_str(), nullptr);
  if (limits->low < 0.0) return TuneKey{name, start, limits->low, limits->high, false};
  if (start == 0.0)
    return Error{fmt::format(
        "--keys: {0} is 0, but tuning multiplies the initial value; set another, for example --set {0}=0.01",
        name)};
  return TuneKey{name, start, std::max(limits->low, start / kMaxFactor),
                 std::min(limits->high, start * kMaxFactor), true};
}

/// How the odometry errs, where the kind is the same whatever is observed.
std::vector<std::string> motion_keys(OdometryKind odometry) {
  switch (odometry) {
    case OdometryKind::kWheels:  // what a wheel errs is slip along the way and turning, both
      return {"motion.wheel_var_m2_per_m", "motion.turn_var_rad2_per_rad"};
    case OdometryKind::kSteering:
      return {"motion.wheel_var_m2_per_m", "motion.steer_var_rad2_m"};
    case OdometryKind::kVelocity:
    case OdometryKind::kPose:
      return {"motion.forward_var_m2_per_m", "motion.turn_var_rad2_per_rad", "motion.turn_var_rad2_per_m"};
  }
  return {};
}

std::vector<std::string> sensor_keys(Observe observe) {
  std::vector<std::string> range{"sensor.range_sigma_m", "sensor.range_sigma_ratio",
                                 "sensor.bias_range_sigma_ratio"};
  std::vector<std::string> bearing{"sensor.bearing_sigma_deg", "sensor.bias_bearing_sigma_deg"};
  switch (observe) {
    case Observe::kRangeBearing: {
      std::vector<std::string> both = range;
      both.insert(both.end(), bearing.begin(), bearing.end());
      return both;
    }
    case Observe::kRange:
      return range;
    case Observe::kBearing:
      return bearing;
    case Observe::kPixel:
      return {"pixel.sigma_px", "pixel.model_sigma_px"};
    case Observe::kMarkers:
      return {"markers.side_sigma_px"};
  }
  return {};
}

}  // namespace

double TuneKey::to_search(double value) const { return by_factor ? std::log(value) : value; }

double TuneKey::to_value(double at) const {
  const double value = by_factor ? std::exp(at) : at;
  return std::clamp(std::strtod(tuned_text(value).c_str(), nullptr), low, high);
}

double TuneKey::first_step() const {
  return by_factor ? kFirstFactor : std::max(kFirstStep, std::abs(start) / 3.0);
}

std::string tuned_text(double value) { return fmt::format("{:.4g}", value); }

std::vector<std::string> assignments(const std::vector<TuneKey>& keys, const std::vector<double>& at) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < keys.size(); ++i)
    all.push_back(fmt::format("{}={}", keys[i].name, keys[i].to_value(at[i])));
  return all;
}

Result<std::vector<TuneKey>> tune_keys(const Config& config, const std::vector<std::string>& names) {
  Config copy = config;
  const Schema schema = describe(copy);
  std::vector<TuneKey> keys;
  for (const auto& name : names) {
    if (std::ranges::find(keys, name, &TuneKey::name) != keys.end())
      return Error{fmt::format("--keys: {} is given twice", name)};
    auto key = tune_key(schema, name);
    if (!key) return key.error();
    keys.push_back(*std::move(key));
  }
  return keys;
}

std::string_view describe(std::optional<OdometryKind> kind) {
  if (!kind) return "no odometry";
  switch (*kind) {
    case OdometryKind::kWheels:
      return "wheel angles";
    case OdometryKind::kVelocity:
      return "velocities";
    case OdometryKind::kSteering:
      return "steering";
    case OdometryKind::kPose:
      return "odometry poses";
  }
  return "";
}

std::vector<std::string> default_tune_keys(const Config& config, std::optional<OdometryKind> odometry) {
  Config copy = config;
  const Schema schema = describe(copy);
  std::vector<std::string> keys;
  if (odometry) keys = motion_keys(*odometry);
  for (auto& key : sensor_keys(config.observe)) keys.push_back(std::move(key));
  std::erase_if(keys, [&schema](const std::string& key) { return schema.value(key) == "0"; });
  return keys;
}

}  // namespace waymark::study
