#pragma once

#include <cstdint>
#include <vector>

#include "workbench/logs/source.hpp"
#include "workbench/sim/options.hpp"
#include "workbench/sim/path.hpp"

namespace waymark::sim {

/// Landmarks at random places, numbered from 0 in the marker family: on both sides of the path, each between
/// the two offsets from its nearest point, or evenly over a square, no nearer to the path than the smaller
/// one while there is room. The options must be valid. O(n^2) in the number of landmarks.
[[nodiscard]] std::vector<TrueLandmark> place_landmarks(const WorldOptions& options, const Path& path,
                                                        std::uint64_t seed);

}  // namespace waymark::sim
