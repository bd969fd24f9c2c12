#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "waymark/core/map_state.hpp"
#include "waymark/core/result.hpp"

namespace waymark {

/// map.csv, for people and plots: one row `id,x_m,y_m,z_m,sxx,sxy,sxz,syy,syz,szz,observations` per landmark.
/// Numbers read back to the last bit; of an id only its number is kept, which is read as that of a marker,
/// below 0 as nobody's.
[[nodiscard]] std::string format_map_csv(const Snapshot& snapshot);
[[nodiscard]] Result<void> write_map_csv(const std::filesystem::path& path, const Snapshot& snapshot);
[[nodiscard]] Result<std::vector<LandmarkEstimate>> read_map_csv(const std::filesystem::path& path);

/// map.waymark, the whole belief (docs/map-format.md): reading gives the same map to the last bit, with line
/// breaks in `made_by` turned to blanks. Size and time grow with the square of the number of landmarks.
[[nodiscard]] Result<std::string> format_map(const MapState& map);
[[nodiscard]] Result<void> write_map(const std::filesystem::path& path, const MapState& map);

/// What a kind of landmark is called in files, and which kind that is.
[[nodiscard]] std::string_view family_name(LandmarkId::Family family);
[[nodiscard]] std::optional<LandmarkId::Family> family_named(std::string_view name);

/// Refuses what is no belief: sizes that disagree, numbers that are not finite, one id twice, a covariance
/// that is not positive semi-definite. Every error names file and line.
[[nodiscard]] Result<MapState> read_map(const std::filesystem::path& path);
/// The same from memory; `name` stands for the file in errors.
[[nodiscard]] Result<MapState> parse_map(std::string text, std::string name);

}  // namespace waymark
