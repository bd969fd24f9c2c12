#pragma once

#include <filesystem>
#include <string>

#include "waymark/core/result.hpp"

namespace waymark {

/// An error unless the path leads to a regular file: reading a device may never end, and opening a pipe may
/// wait for ever.
[[nodiscard]] Result<void> check_is_file(const std::filesystem::path& path);

/// The whole file as bytes.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path);

}  // namespace waymark
