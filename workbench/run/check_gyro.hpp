#pragma once

#include <string>
#include <vector>

#include "waymark/slam/gyro_findings.hpp"

#include "workbench/run/config.hpp"
#include "workbench/run/log_sample.hpp"

namespace waymark {

/// What the gyro of a log is like, as a run meets it. O(events).
[[nodiscard]] GyroFindings gyro_of(const LogSample& sample, const Config& config);

/// Which heading is used, and what is wrong with the gyro or with the wheels, one line each; nothing without
/// a gyro. Times are in seconds since the start of the log.
[[nodiscard]] std::vector<std::string> describe(const GyroFindings& gyro, Stamp start);

}  // namespace waymark
