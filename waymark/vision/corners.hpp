#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "waymark/core/grey_image.hpp"
#include "waymark/kernels/fast_corners.hpp"
#include "waymark/vision/corner_options.hpp"

namespace waymark::vision {

/// A rectangle of pixels: columns u to u + width_px - 1, rows v to v + height_px - 1.
struct PixelRect {
  int u = 0;
  int v = 0;
  int width_px = 0;
  int height_px = 0;
};

struct Corner {
  int u = 0;
  int v = 0;
  std::uint8_t score = 0;  ///< the largest threshold at which it still is a corner

  friend bool operator==(const Corner&, const Corner&) = default;
};

/// FAST corners (Rosten and Drummond 2006) that score more than their eight neighbours. With arc 9 these are
/// the corners and responses of OpenCV's detector.
class CornerDetector {
 public:
  explicit CornerDetector(const CornerOptions& options = {})
      : options_(options), fast_scores_(kernels::fast_scores_by(options.instructions)) {}

  /// Room for images up to this size, so that detect() allocates nothing for them.
  void reserve(int width_px, int height_px);

  /// The corners of the whole image, row by row. Valid until the next call; the detector allocates for its
  /// largest image only.
  const std::vector<Corner>& detect(const ImageView& image);
  /// Those of the whole image that lie in `wanted`, without looking at the rest.
  const std::vector<Corner>& detect(const ImageView& image, const PixelRect& wanted);

 private:
  /// Scores of one row of the cell and of one pixel beside it at both ends.
  struct ScoreRow {
    std::vector<std::uint8_t> scores;
    bool any = false;
  };
  void score_row(const ImageView& image, const PixelRect& cell, int v);
  void add_largest(const PixelRect& cell, int v);
  ScoreRow& row_of(int v) { return rows_[static_cast<std::size_t>(v) % rows_.size()]; }

  CornerOptions options_;
  kernels::FastScores fast_scores_;
  std::array<ScoreRow, 3> rows_;
  std::vector<std::int32_t> places_;
  std::vector<Corner> corners_;
};

}  // namespace waymark::vision
