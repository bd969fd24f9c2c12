#pragma once

#include <optional>
#include <vector>

#include "waymark/core/observation.hpp"
#include "waymark/core/pose2.hpp"
#include "waymark/core/random.hpp"
#include "waymark/models/landmark_sensor.hpp"

#include "workbench/logs/source.hpp"
#include "workbench/sim/options.hpp"

namespace waymark::sim {

/// The sensor as a filter is to be told of it: mount, limits, noise.
[[nodiscard]] LandmarkSensor model_of(const SensorOptions& options);

/// True range and bearing of a point of the world.
[[nodiscard]] RangeBearing sight(const Pose2& T_sensor_world, const Eigen::Vector2d& p_world);

/// Whether a true range and bearing is within the sensor's limits.
[[nodiscard]] bool is_visible(const SensorOptions& options, const RangeBearing& seen);

/// One scan from a true pose of the robot: the landmarks whose true range and bearing are within the sensor's
/// limits, with noise, drops, misread identities and false observations, which lie evenly over range and
/// bearing. Noise may carry a value beyond a limit. All have their identity but clutter. Order follows
/// `landmarks`, clutter behind what it accompanies; a false observation with an identity comes last.
[[nodiscard]] Observations scan(const SensorOptions& options, const Pose2& T_world_robot,
                                const std::vector<TrueLandmark>& landmarks, RandomStream& random);

}  // namespace waymark::sim
