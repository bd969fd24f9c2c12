#include "waymark/slam/map_options.hpp"

#include <fmt/format.h>

#include "waymark/io/map_files.hpp"

namespace waymark {

void describe(Schema& schema, MapOptions& options) {
  schema.text("map.file", options.file, "saved map (map.waymark) to start from; empty: an empty map");
  schema.boolean("map.localize", options.localize,
                 "hold the map of map.file as it is and find the pose alone, from anywhere in it");
}

Result<MapState> read_start_map(const MapOptions& options, int capacity) {
  auto map = read_map(options.file);
  if (!map) return map;
  if (map->landmark_dimension != 2)
    return Error{
        fmt::format("{}: its landmarks are of dimension {}; observe=range-bearing needs a map of dimension 2",
                    options.file, map->landmark_dimension)};
  if (std::ssize(map->ids) > capacity)
    return Error{fmt::format("{}: {} landmarks are more than ekf.capacity={} has room for; set it to more",
                             options.file, map->ids.size(), capacity)};
  return map;
}

}  // namespace waymark
