#pragma once

#include <filesystem>

#include "waymark/core/map_state.hpp"
#include "waymark/core/result.hpp"

namespace waymark {

/// Surveyed landmarks as a map of their own: a table `id,x_m,y_m,sxx,sxy,syy` (m and m^2, frame of the
/// survey), one row per landmark, independent of each other; a column sxy may be left out, and a column z_m
/// is not used. An id is that of the landmark with the same number in `map`; one that is not there is of the
/// kind that its landmarks are. Refuses an id that stands twice and what is no covariance; every error names
/// file and line.
[[nodiscard]] Result<MapState> read_survey(const std::filesystem::path& path, const MapState& map);

}  // namespace waymark
