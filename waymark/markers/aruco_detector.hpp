#pragma once

#include <memory>

#include "waymark/markers/marker_detector.hpp"

namespace waymark::markers {

/// Finds ArUco markers by OpenCV, an error in a build without it. Switches OpenCV's own threads off.
[[nodiscard]] Result<std::unique_ptr<MarkerDetector>> make_aruco_detector(const MarkerDictionary& dictionary);

}  // namespace waymark::markers
