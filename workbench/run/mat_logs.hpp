#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "waymark/core/result.hpp"

#include "workbench/logs/source.hpp"
#include "workbench/run/input_options.hpp"

namespace waymark {

/// "a .mat file of Plaza, lost-in-the-woods, ..."
[[nodiscard]] std::string mat_logs_expected();

/// Is it a .mat file, or a folder with at least one?
[[nodiscard]] bool is_mat_log(const std::filesystem::path& path);

/// Opens a .mat file as the first of mat_formats() that recognises its variables. Of a folder it is the file
/// that one of them names; where there is none, that which input.run asks for.
[[nodiscard]] Result<std::unique_ptr<Source>> open_mat_log(const std::filesystem::path& path,
                                                           const InputOptions& options);

}  // namespace waymark
