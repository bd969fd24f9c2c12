#pragma once

#include <filesystem>
#include <string>

#include "workbench/calibrate/static_study.hpp"

namespace waymark {

/// What was found, and what each place showed, as lines for a terminal.
[[nodiscard]] std::string to_text(const calibrate::StaticStudy& study);

/// The same as JSON.
[[nodiscard]] std::string to_json(const calibrate::StaticStudy& study);

/// The page of it as one HTML file that needs nothing else; `command` is what made it.
[[nodiscard]] std::string render_report(const calibrate::StaticStudy& study, const std::string& command);

/// calibration.yaml, calibration.json and report.html.
[[nodiscard]] Result<void> write_results(const calibrate::StaticStudy& study,
                                         const std::filesystem::path& folder, const std::string& command);

}  // namespace waymark
