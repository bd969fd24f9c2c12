#pragma once

#include <memory>

#include "waymark/core/filter.hpp"
#include "waymark/slam/camera_front_end.hpp"
#include "waymark/slam/config.hpp"
#include "waymark/slam/marker_front_end.hpp"

namespace waymark {

/// The saved map that the config starts from, if it does; refused where the filter cannot take it.
[[nodiscard]] Result<std::optional<MapState>> read_start_map(const Config& config);

/// The filter that the config asks for, at the origin and sure of it, or on from a saved map.
[[nodiscard]] Result<std::unique_ptr<Filter>> make_filter(const Config& config,
                                                          const std::optional<MapState>& start);
/// ... which it reads itself.
[[nodiscard]] Result<std::unique_ptr<Filter>> make_filter(const Config& config);

/// What looks into pictures for a filter over pixels, which must outlive it; null for any other filter.
[[nodiscard]] std::unique_ptr<CameraFrontEnd> make_front_end(const Config& config, Filter& filter,
                                                             const std::optional<MapState>& start = {});

/// What finds markers in pictures where they are asked for, or why it cannot; null where they are not.
[[nodiscard]] Result<std::unique_ptr<MarkerFrontEnd>> make_marker_front_end(const Config& config);

}  // namespace waymark
