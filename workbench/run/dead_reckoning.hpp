#pragma once

#include <span>

#include "waymark/core/event.hpp"
#include "waymark/core/result.hpp"
#include "waymark/core/trajectory.hpp"

#include "workbench/run/config.hpp"

namespace waymark {

/// Where the odometry of a log alone leads from the origin: one pose per reading of the first stream, its
/// heading by a gyro where the log has one. Events in order of time; those of other kinds are passed over. An
/// error where wheels or car are of unknown size. O(n).
[[nodiscard]] Result<Trajectory> dead_reckoning(std::span<const Event> events, const Config& config);

}  // namespace waymark
