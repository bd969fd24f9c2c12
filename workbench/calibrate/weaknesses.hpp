#pragma once

#include <vector>

#include "workbench/calibrate/camera_calibration.hpp"

namespace waymark::calibrate {

/// Why the views are too few, too alike or too poor for the camera that was made of them, the gravest first.
[[nodiscard]] std::vector<Weakness> find_weaknesses(const CameraCalibration& calibration);

}  // namespace waymark::calibrate
