#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "waymark/core/result.hpp"

#include "workbench/config/read_file.hpp"

namespace waymark {

/// Writes a file beside its place and moves it there: a reader sees the old content or the new, never a part.
[[nodiscard]] Result<void> write_file(const std::filesystem::path& path, std::string_view content);

/// Makes the folder and those above it, and makes sure that files can be written there.
[[nodiscard]] Result<void> ensure_output_folder(const std::filesystem::path& folder);

/// The last part of a path, with or without a slash behind it: "logs/loop/" is "loop".
[[nodiscard]] std::string base_name(const std::filesystem::path& path);

}  // namespace waymark
