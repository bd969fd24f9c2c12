#pragma once

#include <string>

#include "waymark/core/map_state.hpp"
#include "waymark/core/result.hpp"

#include "workbench/config/schema.hpp"

namespace waymark {

/// The saved map that a run starts from.
struct MapOptions {
  std::string file;       ///< a map.waymark; empty: an empty map
  bool localize = false;  ///< the map is held as it is, the robot may be anywhere in it
};

void describe(Schema& schema, MapOptions& options);

/// Reads the map, for a filter of landmarks of this dimension with room for `capacity` of them.
[[nodiscard]] Result<MapState> read_start_map(const MapOptions& options, int dimension, int capacity);

}  // namespace waymark
