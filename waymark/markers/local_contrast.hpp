#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "waymark/core/grey_image.hpp"

namespace waymark::markers {

/// How much brighter each pixel of an image is than its surroundings; below zero it is dark. A frame of one
/// bright pixel is around it.
struct ContrastMap {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::int16_t> values;

  [[nodiscard]] std::ptrdiff_t stride() const { return width_px + 2; }
  /// The first pixel of row v, -1 to height_px, of the image; the frame is at -1 and width_px.
  [[nodiscard]] const std::int16_t* row(int v) const { return values.data() + (v + 1) * stride() + 1; }
  [[nodiscard]] std::int16_t* row(int v) { return values.data() + (v + 1) * stride() + 1; }
};

/// What is dark.
struct Darkness {
  int window_px = 9;    ///< side of the square that a pixel is compared with, odd and at most 9
  int margin_grey = 7;  ///< by how much it is darker than the mean there, 0 to 99
};

/// window^2 (I - mean I over the window + margin): below zero where it is dark. Windows that reach beyond the
/// image see its last row or column repeated. Fills `map`, whose memory is used again. Some 0.5 ns per
/// pixel.
void measure_contrast(const ImageView& image, const Darkness& darkness, ContrastMap& map);

}  // namespace waymark::markers
