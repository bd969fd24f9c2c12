#pragma once

#include <memory>
#include <utility>

#include "waymark/core/event.hpp"
#include "waymark/core/random.hpp"

namespace waymark::test {

/// An image of nothing: every pixel is drawn by itself.
inline std::shared_ptr<const GreyImage> noise_image(std::uint64_t seed, int width_px = 320,
                                                    int height_px = 240) {
  RandomStream random(seed, StreamPurpose::kSimulation, 0, 0);
  GreyImage image(width_px, height_px);
  for (int i = 0; i < width_px * height_px; ++i)
    image.data()[i] = static_cast<std::uint8_t>(256.0 * random.uniform());
  return std::make_shared<const GreyImage>(std::move(image));
}

inline std::shared_ptr<const GreyImage> plain_image(std::uint8_t grey) {
  return std::make_shared<const GreyImage>(320, 240, grey);
}

inline Event taken(double seconds, std::shared_ptr<const GreyImage> image) {
  return {stamp_from_seconds(seconds), Image{"", std::move(image)}};
}

}  // namespace waymark::test
