#pragma once

#include <string>
#include <vector>

#include "waymark/slam/odometry_jumps.hpp"

#include "workbench/run/config.hpp"
#include "workbench/run/log_sample.hpp"

namespace waymark {

/// The jumps in the odometry of a log, as a run meets them. O(events).
[[nodiscard]] OdometryJumps jumps_of(const LogSample& sample, const Config& config);

/// One line for each kind of jump: when, in seconds since the start of the log, and how often.
[[nodiscard]] std::vector<std::string> describe(const OdometryJumps& jumps, Stamp start);

}  // namespace waymark
