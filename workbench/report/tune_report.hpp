#pragma once

#include <filesystem>
#include <string>

#include "waymark/core/result.hpp"

#include "workbench/study/tune.hpp"

namespace waymark {

/// The page of a tuning as one HTML file that needs nothing else: per key what it was and is, how far it may
/// move and a profile of the score; scores where data were left out; NIS and errors per log before and after.
/// `command` is what made it.
[[nodiscard]] std::string render_tune_report(const study::TuneResult& result, const std::string& command);

[[nodiscard]] Result<void> write_tune_report(const study::TuneResult& result, const std::string& command,
                                             const std::filesystem::path& path);

/// The result as JSON.
[[nodiscard]] std::string tune_json_text(const study::TuneResult& result);

}  // namespace waymark
