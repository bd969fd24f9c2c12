#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "waymark/slam/odometer.hpp"

#include "workbench/logs/source.hpp"
#include "workbench/run/config.hpp"

namespace waymark {

/// Whether a key can change anything of a run with this config over this log, whose odometry is of this kind;
/// none: it has none. A key that cannot may act on the same log once another is set.
[[nodiscard]] bool can_act(std::string_view key, const Config& config, const LogInfo& log,
                           std::optional<OdometryKind> odometry);

/// The keys that can act on a run, as Schema::to_yaml() writes them: with the same input they give the run
/// again.
[[nodiscard]] std::string acting_yaml(Config config, const LogInfo& log,
                                      std::optional<OdometryKind> odometry);

}  // namespace waymark
