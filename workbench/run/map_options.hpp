#pragma once

#include <string>

#include "waymark/core/map_state.hpp"
#include "waymark/core/result.hpp"

#include "workbench/config/schema.hpp"

namespace waymark {

/// How large the map may become, and the saved one that a run starts from.
struct MapOptions {
  std::string file;       ///< a map.waymark; empty: an empty map
  bool localize = false;  ///< the map is held as it is, the robot may be anywhere in it
  int capacity = 0;       ///< most landmarks; 0: as many as the filter has room for by itself
};

void describe(Schema& schema, MapOptions& options);

/// Reads the map, for a filter of landmarks of this dimension with room for `capacity` of them.
[[nodiscard]] Result<MapState> read_start_map(const MapOptions& options, int dimension, int capacity);

}  // namespace waymark
