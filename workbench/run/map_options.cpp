#include "workbench/run/map_options.hpp"

#include <fmt/format.h>

#include "waymark/vision/patch.hpp"

#include "workbench/logs/map_files.hpp"

namespace waymark {

void describe(Schema& schema, MapOptions& options) {
  schema.text("map.file", options.file,
              "saved map (map.waymark) to start from; empty: start with an empty map", Shown::kAlways);
  schema.boolean(
      "map.localize", options.localize,
      "keep the map of map.file unchanged and estimate only the pose; the robot may start anywhere in it",
      Shown::kAlways);
  schema.integer(
      "map.capacity", options.capacity, {0, 1'000'000},
      "maximum number of landmarks in the map, allocated at the start; 0: 1000, or 100 with observe=pixel",
      Shown::kAlways);
}

Result<MapState> read_start_map(const MapOptions& options, int dimension, int capacity) {
  auto map = read_map(options.file);
  if (!map) return map;
  if (map->landmark_dimension != dimension)
    return Error{
        fmt::format("{}: its landmarks are of dimension {}, but the value of observe needs dimension {}: 2 "
                    "for range and bearing, 3 for pixels",
                    options.file, map->landmark_dimension, dimension)};
  if (std::ssize(map->ids) > capacity)
    return Error{fmt::format("{}: {} landmarks are more than map.capacity={}; raise it", options.file,
                             map->ids.size(), capacity)};
  constexpr std::size_t kPixels = vision::ReferencePatch::kSide * vision::ReferencePatch::kSide;
  for (const LandmarkPatch& patch : map->patches)
    if (patch.pixels.size() != kPixels)
      return Error{fmt::format("{}: the patch of landmark {} has {} pixels; expected {} x {}", options.file,
                               to_string(patch.id), patch.pixels.size(), vision::ReferencePatch::kSide,
                               vision::ReferencePatch::kSide)};
  return map;
}

}  // namespace waymark
