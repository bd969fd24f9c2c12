#pragma once

#include <cstddef>
#include <cstdint>

#include "waymark/kernels/instructions.hpp"

namespace waymark::kernels {

inline constexpr int kMinPatchSize = 8;
inline constexpr int kMaxPatchSize = 16;

/// A square patch of size x size pixels as zmssd_search() wants it.
struct ZmssdPatch {
  static constexpr int kLanes = 2 * kMaxPatchSize;
  static constexpr int kPairs = kMaxPatchSize / 2;

  /// Two rows side by side, column by column; zeros behind the last column, and an odd number of rows begins
  /// with a row of zeros.
  alignas(64) std::int16_t pairs[kPairs][kLanes] = {};
  int size = 0;
  std::uint32_t sum = 0;             ///< of its pixels
  std::uint32_t sum_of_squares = 0;  ///< of its pixels
};

/// size: kMinPatchSize to kMaxPatchSize.
[[nodiscard]] ZmssdPatch make_zmssd_patch(const std::uint8_t* pixels, std::ptrdiff_t stride, int size);

/// Windows side by side in one row of a search; may be none.
struct WindowRow {
  int first = 0;  ///< column of the first pixel of the first window
  int count = 0;
};

/// The zero-mean sum of squared differences between a patch d and windows i of an image in whole numbers
/// (Vincke et al. 2012, equation 14, times the n pixels of the patch):
///
///     n sum (d - i)^2 - (sum d - sum i)^2 = n ZMSSD
///
/// It is at most 256 * 256 * 255^2 < 2^32 for 16 x 16 pixels, and has the same bits on every processor.
/// The first pixels of the windows of rows[k] lie in the k-th row of the image from `pixels` on; the scores
/// are one behind the other as the windows are. Reads no pixels but those of the rectangle around all
/// windows. Of the formula, multiplied out, only sum d i is left to do per window: some nanoseconds at 16 x
/// 16 pixels.
void zmssd_search(const ZmssdPatch& patch, const std::uint8_t* pixels, std::ptrdiff_t stride,
                  const WindowRow* rows, std::size_t row_count, std::uint32_t* scores);

namespace reference {

/// The plain formula for one window.
[[nodiscard]] std::uint32_t zmssd(const std::uint8_t* patch, std::ptrdiff_t patch_stride,
                                  const std::uint8_t* window, std::ptrdiff_t window_stride, int size);

/// zmssd_search() by the plain formula.
void zmssd_search(const ZmssdPatch& patch, const std::uint8_t* pixels, std::ptrdiff_t stride,
                  const WindowRow* rows, std::size_t row_count, std::uint32_t* scores);

}  // namespace reference

using ZmssdSearch = decltype(&zmssd_search);
[[nodiscard]] inline ZmssdSearch zmssd_search_by(Instructions instructions) {
  return instructions == Instructions::kScalar ? reference::zmssd_search : zmssd_search;
}

}  // namespace waymark::kernels
