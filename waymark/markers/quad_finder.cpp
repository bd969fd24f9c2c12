#include "waymark/markers/quad_finder.hpp"

#include <algorithm>
#include <array>

#include "waymark/markers/quad_fit.hpp"

namespace waymark::markers {
namespace {

constexpr double kSideMin_px = 5.0;
constexpr std::size_t kContourPointsMin = 24;

struct Look {
  Darkness darkness;
  bool is_halved = false;  ///< at the image in half its size
};

// What one misses another finds: most markers; those of cells of one or two pixels, which a wide window
// blends; those whose paper is cut off or in the shade, where only the border is truly dark; blurred ones.
constexpr std::array kLooks{
    Look{{.window_px = 9, .margin_grey = 7}}, Look{{.window_px = 5, .margin_grey = 5}},
    Look{{.window_px = 9, .margin_grey = 30}}, Look{{.window_px = 9, .margin_grey = 10}, true}};

/// The means of two by two pixels.
GreyImage halved(const ImageView& image) {
  GreyImage half(image.width_px / 2, image.height_px / 2);
  for (int v = 0; v < half.height_px(); ++v) {
    const std::uint8_t* above = image.row(2 * v);
    const std::uint8_t* below = image.row(2 * v + 1);
    std::uint8_t* means = half.data() + v * half.stride();
    for (int u = 0; u < half.width_px(); ++u)
      means[u] = static_cast<std::uint8_t>(
          (above[2 * u] + above[2 * u + 1] + below[2 * u] + below[2 * u + 1] + 2) / 4);
  }
  return half;
}

/// Pixels count from their centres.
Corners doubled(Corners corners) {
  for (auto& corner : corners) corner = 2.0 * corner.array() + 0.5;
  return corners;
}

/// Not cut off by the edge of the image.
bool is_whole(const Corners& corners, const ImageView& image) {
  return std::ranges::all_of(corners, [&](const Eigen::Vector2d& corner) {
    return corner.minCoeff() >= 0.0 && corner.x() <= image.width_px - 1 && corner.y() <= image.height_px - 1;
  });
}

}  // namespace

std::vector<Corners> QuadFinder::find(const ImageView& image) {
  halved_ = halved(image);
  std::vector<Corners> quads;
  for (const Look& look : kLooks) {
    measure_contrast(look.is_halved ? halved_.view() : image, look.darkness, map_);
    tracer_.trace(map_, kContourPointsMin, [&](const Contour& contour) {
      auto quad = fit_quad(contour, kSideMin_px);
      if (quad && look.is_halved) quad = doubled(*quad);
      if (quad && is_whole(*quad, image)) quads.push_back(*quad);
    });
  }
  return quads;
}

}  // namespace waymark::markers
