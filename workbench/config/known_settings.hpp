#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "waymark/core/result.hpp"

namespace waymark {

/// The settings of configs/NAME.yaml, which is built in: of a published data set, whose reader hands them on
/// as LogInfo has them, or of a simulated world, "sim/NAME".
[[nodiscard]] Result<std::vector<std::pair<std::string, std::string>>> known_settings(std::string_view name);

}  // namespace waymark
