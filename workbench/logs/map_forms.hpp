#pragma once

#include <filesystem>
#include <string>

#include "waymark/core/map_state.hpp"
#include "waymark/core/result.hpp"

namespace waymark {

/// A saved map in the form that the file's name ends with: `.waymark` (map_files.hpp), `.json` with the same
/// content under the same names, or `.csv` as map.csv, which has no correlations, no pose and no kinds of
/// identities.
///
/// From a table comes a map at stamp 0 with the robot surely at the origin, landmarks that are independent of
/// each other, and markers for identities; of dimension 3 where any z is not zero. The other two forms read
/// back to the last bit. Every error names the file.
[[nodiscard]] Result<MapState> read_map_of_any_form(const std::filesystem::path& path);
[[nodiscard]] Result<void> write_map_of_any_form(const std::filesystem::path& path, const MapState& map);

/// The landmarks of a map with their own covariances.
[[nodiscard]] Snapshot snapshot_of(const MapState& map);

}  // namespace waymark
