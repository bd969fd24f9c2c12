#pragma once

#include <string>
#include <vector>

#include "workbench/run/recording.hpp"

namespace waymark {

/// Landmarks with an identity whose observations are refused again and again, one line each, those with most
/// first: ten and more, and a fifth and more of those since the first; or two and more in a row before the
/// filter put a landmark elsewhere that it had matched three times. Where these are most of four and more
/// landmarks, it is not the landmarks: one line says so. `start` is the stamp that seconds are counted from.
/// O(n log n).
[[nodiscard]] std::vector<std::string> describe_refused_landmarks(
    const std::vector<Recording::TimedInnovation>& innovations, Stamp start);

}  // namespace waymark
