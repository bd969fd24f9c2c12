#pragma once

#include <cstddef>
#include <cstdint>

namespace waymark::kernels {

/// How the texels of a summed mipmap lie in memory. A summed mipmap holds a texture reduced in width and in
/// height by every pair of powers of two (lu, lv), so that a texture seen at a slant is averaged along the
/// slant only. All sizes are powers of two, and the texture repeats.
///
/// An element holds a texel in its low byte and the texel below in its high byte, and a row ends with its
/// first element once more: one load of 32 bits fetches the four texels of a bilinear interpolation.
struct MipmapLayout {
  int log2_width = 0;
  int log2_height = 0;
  int levels = 1;  ///< in either direction; at most 1 + the smaller logarithm

  [[nodiscard]] std::int32_t width(int lu) const { return (1 << log2_width) >> lu; }
  [[nodiscard]] std::int32_t height(int lv) const { return (1 << log2_height) >> lv; }
  /// Where the columns of level lu begin: after those of the levels before, each one element longer.
  [[nodiscard]] std::int32_t first_column(int lu) const {
    return (2 << log2_width) - ((2 << log2_width) >> lu) + lu;
  }
  [[nodiscard]] std::int32_t first_row(int lv) const {
    return (2 << log2_height) - ((2 << log2_height) >> lv);
  }
  [[nodiscard]] std::int32_t pitch() const { return first_column(levels); }
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(pitch()) * static_cast<std::size_t>(first_row(levels));
  }
};

}  // namespace waymark::kernels
