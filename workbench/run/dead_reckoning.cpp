#include "workbench/run/dead_reckoning.hpp"

#include <optional>

#include "waymark/slam/odometer.hpp"

namespace waymark {
namespace {

Result<void> check_size_of(const Event& event, const OdometryOptions& options) {
  if (std::holds_alternative<WheelAngles>(event.content)) return check(options.wheels);
  if (std::holds_alternative<Steering>(event.content)) return check(options.car);
  return {};
}

/// The first event from `index` on that `is_wanted`.
template <class IsWanted>
const Event* next_of(std::span<const Event> events, std::size_t& index, std::size_t from,
                     const IsWanted& is_wanted) {
  if (index < from) index = from;
  while (index < events.size() && !is_wanted(events[index])) ++index;
  return index < events.size() ? &events[index] : nullptr;
}

bool is_yaw_rate(const Event& event) { return std::holds_alternative<YawRate>(event.content); }

}  // namespace

Result<Trajectory> dead_reckoning(std::span<const Event> events, const Config& config) {
  Odometer odometer(config.odometry, config.pipeline.max_hold_s);
  Trajectory path;
  Pose2 T_odom_robot;
  std::optional<Stamp> now;
  std::size_t next_reading = 0, next_yaw_rate = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = events[i];
    if (!measures_motion(event.content) || (now && event.stamp < *now)) continue;
    if (auto known = check_size_of(event, config.odometry); !known) return known.error();
    const Event* reading = next_of(events, next_reading, i, [&](const Event& each) {
      return is_odometry(each.content) && odometer.follows(each);
    });
    const Event* yaw_rate = next_of(events, next_yaw_rate, i, is_yaw_rate);
    T_odom_robot = T_odom_robot * odometer.advance(event.stamp, reading, yaw_rate).increment;
    now = event.stamp;
    if (odometer.add(event) && is_odometry(event.content))
      path.push_back({event.stamp, T_odom_robot, std::nullopt});
  }
  return path;
}

}  // namespace waymark
