#pragma once

#include <memory>
#include <optional>

#include "waymark/core/filter.hpp"
#include "waymark/core/map_state.hpp"
#include "waymark/core/result.hpp"
#include "waymark/slam/front_end.hpp"

#include "workbench/run/config.hpp"

namespace waymark {

/// A filter, and what looks into images for it, null where nothing does.
struct FilterSystem {
  std::unique_ptr<Filter> filter;
  std::unique_ptr<FrontEnd> front_end;  ///< last: it works on the filter
};

/// The saved map that the config starts from, if it does; refused where the filter cannot take it.
[[nodiscard]] Result<std::optional<MapState>> read_start_map(const Config& config);

/// What the config asks for, at the origin and sure of it, or on from a saved map.
[[nodiscard]] Result<FilterSystem> make_filter_system(const Config& config,
                                                      const std::optional<MapState>& start);

/// What finds markers in images where they are asked for, or why it cannot; null where they are not.
[[nodiscard]] Result<std::unique_ptr<FrontEnd>> make_marker_front_end(const Config& config);

/// The filter alone, for observations that come as such; it reads the map that the config starts from.
[[nodiscard]] Result<std::unique_ptr<Filter>> make_filter(const Config& config);

}  // namespace waymark
