#pragma once

#include <string>
#include <vector>

#include "workbench/run/config.hpp"
#include "workbench/run/log_sample.hpp"

namespace waymark {

/// What cannot be right in a log, one line each: by how odometry and observations fit each other (fit_of()),
/// and where that neither shows that all is right nor what is wrong, by the numbers alone (check_units()).
[[nodiscard]] std::vector<std::string> contradictions_in(const LogSample& sample, const Config& config);

/// Why nothing can be run on a log without odometry.
[[nodiscard]] std::string describe_missing_odometry(const LogInfo& log);

}  // namespace waymark
