#pragma once

#include <filesystem>
#include <string>

#include "waymark/core/result.hpp"

#include "workbench/calibrate/log_calibration.hpp"

namespace waymark {

/// What a log says of its robot: as lines for a person, as JSON, and as one HTML file that needs nothing else
/// (dead reckoning before and after over the path by the whole log, what was found with its uncertainty).
/// `command` is what made it.
[[nodiscard]] std::string to_text(const calibrate::LogCalibration& calibration);
[[nodiscard]] std::string to_json(const calibrate::LogCalibration& calibration);
[[nodiscard]] std::string render_report(const calibrate::LogCalibration& calibration,
                                        const std::string& command);

/// Writes calibration.yaml, calibration.json and report.html into a folder.
[[nodiscard]] Result<void> write_results(const calibrate::LogCalibration& calibration,
                                         const std::filesystem::path& folder, const std::string& command);

}  // namespace waymark
