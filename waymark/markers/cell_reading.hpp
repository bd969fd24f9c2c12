#pragma once

#include <cstdint>
#include <optional>

#include "waymark/core/grey_image.hpp"
#include "waymark/markers/corners.hpp"

namespace waymark::markers {

/// What the cells of a quadrilateral say where it is a marker.
struct CellReading {
  std::uint64_t bits = 0;  ///< inside the border, row after row, the first is the highest; 1 is white
  int wrong_border = 0;    ///< cells of the border that are not black
  int divided = 0;         ///< cells, of the border too, that are neither black nor white throughout
};

/// Reads `bits_per_side` x `bits_per_side` cells inside a border of one. Black is what the border is and
/// white what is around it, each a plane of grey over the marker (Olson 2011); cells are sharpened by their
/// neighbours, since those of small markers blend. Nothing where the paper is hardly brighter than the
/// border.
[[nodiscard]] std::optional<CellReading> read_cells(const ImageView& image, const Corners& corners_px,
                                                    int bits_per_side);

}  // namespace waymark::markers
