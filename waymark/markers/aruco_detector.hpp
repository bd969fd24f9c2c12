#pragma once

#include <memory>

#include "waymark/markers/marker_detector.hpp"

namespace waymark::markers {

/// Finds ArUco markers: dark quadrilaterals whose cells are a pattern of the dictionary.
[[nodiscard]] std::unique_ptr<MarkerDetector> make_aruco_detector(const MarkerDictionary& dictionary);

}  // namespace waymark::markers
