#pragma once

#include "waymark/core/grey_image.hpp"

#include "workbench/calibrate/board.hpp"

namespace waymark::calibrate {

/// How many pixels the grey takes from dark to light (10 to 90 %) across the edges between neighbouring
/// corners, the wider of the two directions: 1 to 2 in a sharp image, more where the focus or the hand was
/// off. The median over the edges of a direction; 0 where no edge can be judged.
[[nodiscard]] double edge_width_px(const ImageView& image, const Board& board, const BoardCorners& corners);

}  // namespace waymark::calibrate
