#pragma once

#include <algorithm>
#include <cmath>

#include "waymark/core/grey_image.hpp"
#include "waymark/core/random.hpp"

namespace waymark::test {

/// Squares of 8 to 30 pixels on each other, and noise: corners everywhere.
inline GreyImage squares(int width_px, int height_px, RandomStream& random, double grey_sigma = 0.0) {
  GreyImage image(width_px, height_px, 120);
  for (int i = 0; i < width_px * height_px / 150; ++i) {
    const int side = static_cast<int>(random.uniform(8.0, 30.0));
    const int u0 = static_cast<int>(random.uniform(-8.0, width_px)),
              v0 = static_cast<int>(random.uniform(-8.0, height_px));
    const auto grey = static_cast<std::uint8_t>(random.uniform(30.0, 220.0));
    for (int v = std::max(v0, 0); v < std::min(v0 + side, height_px); ++v)
      for (int u = std::max(u0, 0); u < std::min(u0 + side, width_px); ++u) image(u, v) = grey;
  }
  if (grey_sigma > 0.0)
    for (int v = 0; v < height_px; ++v)
      for (int u = 0; u < width_px; ++u)
        image(u, v) = static_cast<std::uint8_t>(image(u, v) + std::lround(grey_sigma * random.normal()));
  return image;
}

}  // namespace waymark::test
