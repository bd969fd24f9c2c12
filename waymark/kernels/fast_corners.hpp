#pragma once

#include <cstddef>
#include <cstdint>

#include "waymark/kernels/instructions.hpp"

namespace waymark::kernels {

/// Pixels around a corner candidate that its test looks at: a circle of radius 3.
inline constexpr int kFastRadius = 3;
inline constexpr int kMinFastArc = 9;
inline constexpr int kMaxFastArc = 12;

/// Corner scores of `count` pixels side by side (Rosten and Drummond 2006): a pixel is a corner where `arc`
/// (9 to 12) neighbouring pixels of the 16 on its circle are all brighter or all darker than it by more than
/// `threshold`. Its score is the largest threshold that it still passes; that of other pixels is 0. `first`
/// has kFastRadius pixels on every side of it and of the last one. Returns whether any pixel is a corner.
bool fast_scores(const std::uint8_t* first, std::ptrdiff_t stride, std::size_t count, std::uint8_t threshold,
                 int arc, std::uint8_t* scores);

/// The places k, in order, where the score is larger than those of all eight neighbours, for three rows of
/// scores of which [-1, count] can be read; returns how many. `places` has room for (count + 1) / 2.
std::size_t largest_scores(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below,
                           std::size_t count, std::int32_t* places);

namespace reference {

[[nodiscard]] std::uint8_t fast_score(const std::uint8_t* pixel, std::ptrdiff_t stride,
                                      std::uint8_t threshold, int arc);

/// fast_scores() pixel by pixel. The four pixels of the compass come first, as in Rosten and Drummond's own
/// test: an arc of twelve holds three of them, one of nine two.
bool fast_scores(const std::uint8_t* first, std::ptrdiff_t stride, std::size_t count, std::uint8_t threshold,
                 int arc, std::uint8_t* scores);

}  // namespace reference

using FastScores = decltype(&fast_scores);
[[nodiscard]] inline FastScores fast_scores_by(Instructions instructions) {
  return instructions == Instructions::kScalar ? reference::fast_scores : fast_scores;
}

}  // namespace waymark::kernels
