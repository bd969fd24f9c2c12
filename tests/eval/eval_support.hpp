#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "waymark/core/random.hpp"
#include "waymark/core/trajectory.hpp"

#include "workbench/eval/truth_track.hpp"
#include "workbench/logs/source.hpp"

namespace waymark::eval::test {

inline RandomStream random_stream(std::uint64_t step) { return {7, StreamPurpose::kSimulation, step}; }

inline Pose2 random_pose(RandomStream& random, double size_m = 10.0) {
  return {random.uniform(-size_m, size_m), random.uniform(-size_m, size_m), random.uniform(-kPi, kPi)};
}

inline std::vector<Eigen::Vector2d> random_points(RandomStream& random, int count, double size_m = 10.0) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i)
    points.emplace_back(random.uniform(-size_m, size_m), random.uniform(-size_m, size_m));
  return points;
}

inline std::vector<Eigen::Vector2d> moved(const Pose2& T, const std::vector<Eigen::Vector2d>& points) {
  std::vector<Eigen::Vector2d> result;
  for (const Eigen::Vector2d& p : points) result.push_back(T * p);
  return result;
}

inline Trajectory moved(const Pose2& T, Trajectory trajectory) {
  for (TrajectoryPoint& point : trajectory) point.pose = T * point.pose;
  return trajectory;
}

/// A wavy path: one pose every 0.1 s from `start_s` on, heading along the path and through +-pi now and then.
inline Trajectory wavy_path(int count, double start_s = 0.0) {
  Trajectory path;
  Pose2 pose;
  for (int i = 0; i < count; ++i) {
    path.push_back({stamp_from_seconds(start_s + 0.1 * i), pose, std::nullopt});
    pose = pose * Pose2{0.1, 0.0, 0.06 * std::sin(0.01 * i) + 0.02};
  }
  return path;
}

/// One metre per second along x, one pose every `step_s`.
inline Trajectory straight_path(int count, double step_s = 1.0) {
  Trajectory path;
  for (int i = 0; i < count; ++i)
    path.push_back({stamp_from_seconds(step_s * i), {step_s * i, 0.0, 0.0}, std::nullopt});
  return path;
}

inline TrueLandmark surveyed(int number, double x_m, double y_m, double z_m = 0.0) {
  return {{LandmarkId::Family::kBarcode, number}, x_m, y_m, z_m};
}

inline TruthSample truth_at(double seconds, double x_m, double y_m,
                            std::optional<double> theta_rad = std::nullopt) {
  return {stamp_from_seconds(seconds), {x_m, y_m, theta_rad}};
}

}  // namespace waymark::eval::test
