#pragma once

#include <filesystem>
#include <string>

#include "waymark/calibrate/sensor_noise.hpp"
#include "waymark/core/result.hpp"

namespace waymark {

/// Noise of a sensor as lines for a person, and as JSON with the bins by range and bearing.
[[nodiscard]] std::string to_text(const calibrate::SensorNoise& noise);
[[nodiscard]] std::string to_json(const calibrate::SensorNoise& noise);

/// The page of it as one HTML file that needs nothing else; `command` is what made it.
[[nodiscard]] std::string render_report(const calibrate::SensorNoise& noise, const std::string& command);

/// calibration.yaml, calibration.json and report.html.
[[nodiscard]] Result<void> write_results(const calibrate::SensorNoise& noise,
                                         const std::filesystem::path& folder, const std::string& command);

}  // namespace waymark
