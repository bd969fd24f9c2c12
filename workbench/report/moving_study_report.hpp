#pragma once

#include <filesystem>
#include <string>

#include "waymark/core/result.hpp"

#include "workbench/calibrate/moving_study.hpp"

namespace waymark {

/// What was found of a moving sensor as lines for a person, and as JSON with the bins by range and bearing.
[[nodiscard]] std::string to_text(const calibrate::MovingStudy& study);
[[nodiscard]] std::string to_json(const calibrate::MovingStudy& study);

/// The page of it as one HTML file that needs nothing else; `command` is what made it.
[[nodiscard]] std::string render_report(const calibrate::MovingStudy& study, const std::string& command);

/// calibration.yaml, calibration.json and report.html.
[[nodiscard]] Result<void> write_results(const calibrate::MovingStudy& study,
                                         const std::filesystem::path& folder, const std::string& command);

}  // namespace waymark
