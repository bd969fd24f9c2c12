#pragma once

#include <filesystem>
#include <memory>

#include "waymark/core/result.hpp"

#include "workbench/logs/source.hpp"
#include "workbench/run/input_options.hpp"

namespace waymark {

/// Opens a recording as the first of input_formats() that recognises it. Where none does, the error says what
/// they expect and what is there instead.
[[nodiscard]] Result<std::unique_ptr<Source>> open_source(const std::filesystem::path& path,
                                                          const InputOptions& options = {});

}  // namespace waymark
