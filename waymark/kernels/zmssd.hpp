#pragma once

#include <cstddef>
#include <cstdint>

namespace waymark::kernels {

inline constexpr int kMinPatchSize = 8;
inline constexpr int kMaxPatchSize = 16;

/// A square patch of size x size pixels as zmssd_row() wants it.
struct ZmssdPatch {
  static constexpr int kLanes = 32;

  /// Row by row, each repeated to the end: every 8 lanes at size 8, else every 16 with zeros behind the row.
  alignas(64) std::int16_t rows[kMaxPatchSize][kLanes] = {};
  int size = 0;
  std::uint32_t sum = 0;             ///< of its pixels
  std::uint32_t sum_of_squares = 0;  ///< of its pixels
};

/// size: kMinPatchSize to kMaxPatchSize.
[[nodiscard]] ZmssdPatch make_zmssd_patch(const std::uint8_t* pixels, std::ptrdiff_t stride, int size);

/// The zero-mean sum of squared differences between a patch d and `count` windows i of an image, whose first
/// pixels are first, first + 1, ..., in whole numbers (Vincke et al. 2012, equation 14, times the n pixels of
/// the patch):
///
///     scores[k] = n sum (d - i)^2 - (sum d - sum i)^2 = n ZMSSD
///
/// It is at most 256 * 256 * 255^2 - ... < 2^32 for 16 x 16 pixels, and has the same bits on every processor.
/// Reads the pixels of the windows and no others. Expanded, only sum d i is left to do per window: a few
/// nanoseconds of a 16 x 16 patch.
void zmssd_row(const ZmssdPatch& patch, const std::uint8_t* first, std::ptrdiff_t stride, std::size_t count,
               std::uint32_t* scores);

namespace reference {

/// The plain formula for one window.
[[nodiscard]] std::uint32_t zmssd(const std::uint8_t* patch, std::ptrdiff_t patch_stride,
                                  const std::uint8_t* window, std::ptrdiff_t window_stride, int size);

}  // namespace reference
}  // namespace waymark::kernels
