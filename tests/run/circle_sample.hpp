#pragma once

#include <cmath>
#include <functional>

#include "workbench/run/log_sample.hpp"

namespace waymark::test {

/// A robot that drives a circle of 2 m at 0.4 m/s for a minute, and observes landmarks all around at 5 Hz.
/// `make` tells its odometry at 20 Hz.
inline LogSample circle_sample(
    const std::function<EventContent(double t_s, const Pose2& pose)>& make,
    const std::function<RangeBearing(RangeBearing, const Pose2& pose)>& tell = {}) {
  LogSample sample;
  const auto pose_at = [](double t_s) {
    const double theta_rad = 0.2 * t_s;
    return Pose2{2.0 * std::sin(theta_rad), 2.0 - 2.0 * std::cos(theta_rad), wrap_angle(theta_rad)};
  };
  for (int i = 0; i <= 1200; ++i) {
    const double t_s = 0.05 * i;
    sample.add(Event(stamp_from_seconds(t_s), make(t_s, pose_at(t_s))), {});
    if (i % 4 != 0) continue;
    Observations seen;
    for (int id = 0; id < 5; ++id) {
      const Eigen::Vector2d p =
          pose_at(t_s).inverse() * Eigen::Vector2d(4.0 * std::cos(1.3 * id), 2.0 + 4.0 * std::sin(1.3 * id));
      const RangeBearing z{p.norm(), std::atan2(p.y(), p.x())};
      seen.push_back({LandmarkId{LandmarkId::Family::kMarker, id}, tell ? tell(z, pose_at(t_s)) : z, {}});
    }
    sample.add(Event(stamp_from_seconds(t_s), seen), {});
  }
  return sample;
}

inline EventContent told_pose(double, const Pose2& pose) { return OdometryPose{pose}; }
inline EventContent told_velocity(double, const Pose2&) { return Velocity{0.4, 0.2}; }
/// Of wheels of 0.1 m, 0.3 m apart.
inline WheelAngles circle_wheels(double t_s) { return {3.7 * t_s, 4.3 * t_s}; }

}  // namespace waymark::test
