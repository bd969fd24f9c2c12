#pragma once

#include <filesystem>
#include <vector>

#include "waymark/core/result.hpp"

namespace waymark {

/// The recording that input.run asks for among those of a folder, counted from 1.
[[nodiscard]] Result<std::filesystem::path> choose_run(const std::filesystem::path& folder,
                                                       const std::vector<std::filesystem::path>& runs,
                                                       int run);

}  // namespace waymark
