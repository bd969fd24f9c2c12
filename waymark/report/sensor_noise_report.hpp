#pragma once

#include <filesystem>
#include <string>

#include "waymark/calibrate/sensor_noise.hpp"
#include "waymark/core/result.hpp"

namespace waymark {

/// Noise of a sensor as lines for a person, and as JSON with the bins by range and bearing.
[[nodiscard]] std::string to_text(const calibrate::SensorNoise& noise);
[[nodiscard]] std::string to_json(const calibrate::SensorNoise& noise);

/// Writes calibration.yaml and calibration.json into a folder.
[[nodiscard]] Result<void> write_results(const calibrate::SensorNoise& noise,
                                         const std::filesystem::path& folder);

}  // namespace waymark
