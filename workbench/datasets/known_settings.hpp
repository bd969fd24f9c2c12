#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "waymark/core/result.hpp"

namespace waymark {

/// The settings of a published data set, which its reader hands on as LogInfo has them: configs/NAME.yaml,
/// which is built in.
[[nodiscard]] Result<std::vector<std::pair<std::string, std::string>>> known_settings(std::string_view name);

}  // namespace waymark
