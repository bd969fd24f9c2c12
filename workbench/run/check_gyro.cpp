#include "workbench/run/check_gyro.hpp"

#include <cmath>

#include <fmt/format.h>

#include "waymark/core/angle.hpp"
#include "waymark/slam/odometer.hpp"

namespace waymark {
namespace {

std::string times(const Occurrences& occurrences, Stamp start) {
  const double first_s = to_seconds(occurrences.first - start);
  return occurrences.count == 1 ? fmt::format("once, at {:.2f} s", first_s)
                                : fmt::format("{} times, first at {:.2f} s", occurrences.count, first_s);
}

/// Wheels and cars of unknown size turn by nobody knows how much.
bool tells_turns(const LogSample& sample, const OdometryOptions& options) {
  if (sample.odometry.empty()) return false;
  const EventContent& told = sample.odometry.front().content;
  if (std::holds_alternative<WheelAngles>(told)) return check(options.wheels).ok();
  return !std::holds_alternative<Steering>(told) || check(options.car).ok();
}

/// Why the gyro is not believed.
std::string reason(const GyroFindings& gyro) {
  if (gyro.is_constant) return "it tells the same rate all the time";
  if (!gyro.ratio) return "the odometry turns too little to compare them";
  return fmt::format(
      "it turns {:.2g} times as much as the odometry: its mount, its unit or the turns of the odometry are "
      "wrong",
      *gyro.ratio);
}

std::string heading_line(const GyroFindings& gyro) {
  if (!gyro.is_believed)
    return fmt::format("the gyro is not used, and the heading is the odometry's: {}", reason(gyro));
  return fmt::format(
      "the heading is held by the gyro, whose bias is {:.3f} +- {:.3f} degrees per second, {} "
      "(input.imu_topic=none, or no imu.csv, leaves it to the odometry)",
      to_degrees(gyro.bias_radps), to_degrees(gyro.bias_sigma_radps),
      gyro.has_stood ? "learnt while the wheels stood" : "known badly because the wheels never stood");
}

/// How its readings are turned into rad/s, counter-clockwise.
std::string unit_line(const GyroFindings& gyro) {
  const bool is_turned = gyro.factor < 0.0;
  const bool is_degrees = std::abs(gyro.factor) < 1.0;
  return fmt::format(
      "the gyro turns {:.2g} times as much as the odometry: {}{}{}; it has to be in rad/s, counter-clockwise",
      gyro.ratio.value_or(0.0), is_degrees ? "it is taken as degrees per second" : "",
      is_degrees && is_turned ? ", and " : "",
      is_turned ? "its sign is changed (does its z axis point down, or are the wheels exchanged?)" : "");
}

}  // namespace

GyroFindings gyro_of(const LogSample& sample, const Config& config) {
  if (!tells_turns(sample, config.odometry)) return {};
  Odometer odometer(config.odometry, config.pipeline.max_hold_s);
  auto reading = sample.odometry.begin();
  auto rate = sample.yaw_rates.begin();
  const auto end = sample.odometry.end();
  const auto last = sample.yaw_rates.end();
  while (reading != end && rate != last) {
    auto& first = reading->stamp <= rate->stamp ? reading : rate;
    static_cast<void>(odometer.advance(first->stamp, &*reading, &*rate));
    odometer.add(*first++);
  }
  return odometer.gyro();
}

std::vector<std::string> describe(const GyroFindings& gyro, Stamp start) {
  if (gyro.readings == 0) return {};
  std::vector<std::string> lines{heading_line(gyro)};
  if (gyro.factor != 1.0) lines.push_back(unit_line(gyro));
  if (!gyro.odometry_turns)
    lines.emplace_back("the odometry never turns while the gyro does: every turn is the gyro's");
  if (gyro.slips.count > 0)
    lines.push_back(
        fmt::format("odometry and gyro turn differently {}: the wheels slip, and the gyro is believed",
                    times(gyro.slips, start)));
  if (gyro.stuck.count > 0)
    lines.push_back(fmt::format(
        "the gyro is stuck {}: it repeats one reading while the odometry turns, and the odometry is believed",
        times(gyro.stuck, start)));
  return lines;
}

}  // namespace waymark
