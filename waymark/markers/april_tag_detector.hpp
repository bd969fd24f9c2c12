#pragma once

#include <memory>

#include "waymark/markers/marker_detector.hpp"

namespace waymark::markers {

/// Finds AprilTags by libapriltag, an error in a build without it.
[[nodiscard]] Result<std::unique_ptr<MarkerDetector>> make_april_tag_detector(
    const MarkerDictionary& dictionary);

}  // namespace waymark::markers
