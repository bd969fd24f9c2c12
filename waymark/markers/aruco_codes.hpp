#pragma once

#include <cstdint>

#include "waymark/markers/marker_dictionary.hpp"

namespace waymark::markers {

/// The pattern of a marker of an ArUco dictionary, `number` from 0 to below its size: its bits row after row,
/// the upper left one the highest; 1 is white.
[[nodiscard]] std::uint64_t aruco_code(const MarkerDictionary& dictionary, int number);

}  // namespace waymark::markers
