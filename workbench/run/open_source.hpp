#pragma once

#include <filesystem>
#include <memory>

#include "waymark/core/result.hpp"

#include "workbench/logs/source.hpp"
#include "workbench/run/input_options.hpp"

namespace waymark {

/// Does any of input_formats() recognise it? Only looked at, not read.
[[nodiscard]] bool is_log(const std::filesystem::path& path);

/// Opens a recording as the first of input_formats() that recognises it. Where none does, the error says what
/// they expect and what is there instead.
[[nodiscard]] Result<std::unique_ptr<Source>> open_source(const std::filesystem::path& path,
                                                          const InputOptions& options = {});

}  // namespace waymark
