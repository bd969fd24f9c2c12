#pragma once

#include <string>
#include <vector>

#include "workbench/calibrate/view.hpp"

namespace waymark::calibrate {

/// The part of 8 x 6 cells over the image that have a corner of a used view in them.
[[nodiscard]] double covered_part(const std::vector<BoardView>& views, ImageSize size);

/// Which of the ninths of the image have no corner: "upper left", "left", ...; empty where all have.
[[nodiscard]] std::vector<std::string> empty_ninths(const std::vector<BoardView>& views, ImageSize size);

}  // namespace waymark::calibrate
