#pragma once

#include "waymark/core/grey_image.hpp"
#include "waymark/markers/corners.hpp"

namespace waymark::markers {

/// Is there white paper around a black border? Looks at the middles of the border's cells and of those around
/// them: what a wall happens to show with the bits of a marker seldom has both. `cells` along a side, the
/// border included.
[[nodiscard]] bool has_black_border(const ImageView& image, const Corners& corners_px, int cells);

}  // namespace waymark::markers
