#pragma once

#include <algorithm>
#include <vector>

#include "waymark/core/grey_image.hpp"
#include "waymark/vision/corners.hpp"

namespace waymark::test {

/// The strongest corner of each cell of 40 x 40 pixels.
inline std::vector<vision::Corner> spread_corners(const ImageView& image,
                                                  const vision::CornerOptions& options = {}) {
  constexpr int kCell_px = 40;
  vision::CornerDetector detector(options);
  std::vector<vision::Corner> chosen;
  for (int v = 0; v < image.height_px; v += kCell_px) {
    for (int u = 0; u < image.width_px; u += kCell_px) {
      const auto& corners = detector.detect(image, {u, v, kCell_px, kCell_px});
      const auto best = std::ranges::max_element(corners, {}, &vision::Corner::score);
      if (best != corners.end()) chosen.push_back(*best);
    }
  }
  return chosen;
}

}  // namespace waymark::test
