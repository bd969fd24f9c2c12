#include "waymark/vision/corners.hpp"

#include <algorithm>

namespace waymark::vision {
namespace {

using kernels::kFastRadius;

/// The part of the image whose pixels have a whole circle around them.
PixelRect interior(const ImageView& image) {
  return {kFastRadius, kFastRadius, image.width_px - 2 * kFastRadius, image.height_px - 2 * kFastRadius};
}

PixelRect intersection(const PixelRect& a, const PixelRect& b) {
  const int u = std::max(a.u, b.u), v = std::max(a.v, b.v);
  return {u, v, std::min(a.u + a.width_px, b.u + b.width_px) - u,
          std::min(a.v + a.height_px, b.v + b.height_px) - v};
}

PixelRect widened(const PixelRect& r) { return {r.u - 1, r.v - 1, r.width_px + 2, r.height_px + 2}; }

/// Vectors of this many pixels are scored at once; fewer go pixel by pixel.
constexpr int kVector = 64;

bool is_empty(const PixelRect& r) { return r.width_px <= 0 || r.height_px <= 0; }

}  // namespace

const std::vector<Corner>& CornerDetector::detect(const ImageView& image) {
  return detect(image, {0, 0, image.width_px, image.height_px});
}

const std::vector<Corner>& CornerDetector::detect(const ImageView& image, const PixelRect& wanted) {
  corners_.clear();
  const PixelRect cell = intersection(wanted, interior(image));
  if (is_empty(cell)) return corners_;
  reserve(cell.width_px, cell.height_px);
  for (int v = cell.v - 1; v <= cell.v + cell.height_px; ++v) {
    score_row(image, cell, v);
    if (v > cell.v && row_of(v - 1).any) add_largest(cell, v - 1);
  }
  return corners_;
}

void CornerDetector::reserve(int width_px, int height_px) {
  const auto width = static_cast<std::size_t>(width_px), height = static_cast<std::size_t>(height_px);
  for (ScoreRow& row : rows_)
    if (row.scores.size() < width + 2 + kVector) row.scores.resize(width + 2 + kVector);
  if (places_.size() < (width + 1) / 2) places_.resize((width + 1) / 2);
  corners_.reserve(((width + 1) / 2) * ((height + 1) / 2));
}

void CornerDetector::score_row(const ImageView& image, const PixelRect& cell, int v) {
  ScoreRow& row = row_of(v);
  // Pixels without a whole circle are no corners.
  PixelRect scored =
      intersection(intersection(widened(cell), interior(image)), {cell.u - 1, v, cell.width_px + 2, 1});
  row.any = false;
  if (is_empty(scored)) {
    std::fill_n(row.scores.begin(), cell.width_px + 2, std::uint8_t{0});
    return;
  }
  const int to_the_right = interior(image).u + interior(image).width_px - scored.u;
  scored.width_px = std::max(scored.width_px, std::min(kVector, to_the_right));
  row.scores[0] = row.scores[static_cast<std::size_t>(cell.width_px) + 1] = 0;
  row.any = fast_scores_(image.pixel(scored.u, v), image.stride, static_cast<std::size_t>(scored.width_px),
                         static_cast<std::uint8_t>(options_.threshold), options_.arc,
                         row.scores.data() + (scored.u - cell.u + 1));
}

void CornerDetector::add_largest(const PixelRect& cell, int v) {
  const std::uint8_t* scores = row_of(v).scores.data() + 1;
  const std::size_t found =
      kernels::largest_scores(row_of(v - 1).scores.data() + 1, scores, row_of(v + 1).scores.data() + 1,
                              static_cast<std::size_t>(cell.width_px), places_.data());
  for (std::size_t i = 0; i < found; ++i) corners_.push_back({cell.u + places_[i], v, scores[places_[i]]});
}

}  // namespace waymark::vision
