#pragma once

#include <string>
#include <vector>

#include "workbench/run/config.hpp"
#include "workbench/run/log_sample.hpp"

namespace waymark {

/// Numbers that can hardly be in the units that a log has to have, one line each: bearings beyond 2 pi (5 %
/// of them), ranges most of which the sensor's limits refuse, speeds above 30 m/s and turn rates above 15
/// rad/s (a tenth of the time), readings of odometry 10 s and more apart (half of them), odometry that lasts
/// a hundred times as long as the observations or the other way round. O(events).
[[nodiscard]] std::vector<std::string> check_units(const LogSample& sample, const Config& config);

}  // namespace waymark
