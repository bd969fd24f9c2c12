#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "waymark/core/grey_image.hpp"
#include "waymark/core/result.hpp"

#include "workbench/logs/used_bits.hpp"

namespace waymark {

/// A grey image of up to 16 bits a pixel, row after row without gaps.
struct DeepImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint16_t> values;
};

/// A PNG file of 16 bits a sample: its stored values, mixed to grey = 0.299 R + 0.587 G + 0.114 B,
/// transparent parts on black. Cost: the unpacked file in memory. An error says why, without naming the file.
[[nodiscard]] Result<DeepImage> decode_deep_png(std::string_view bytes);

/// The image with 8 bits, by the bits that it and those before it use.
[[nodiscard]] GreyImage to_grey(const DeepImage& image, UsedBits& bits);

}  // namespace waymark
