#include "workbench/sim/summed_mipmap.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace waymark::sim {
namespace {

// A texture of 5 mm is seen from the next room at most.
constexpr int kLevelsMax = 7;

kernels::MipmapLayout layout_of(const Canvas& canvas) {
  const int levels = 1 + std::min(canvas.log2_width(), canvas.log2_height());
  return {canvas.log2_width(), canvas.log2_height(), std::min(levels, kLevelsMax)};
}

/// Grey values, row after row.
struct Level {
  int width = 0;
  int height = 0;
  std::vector<float> grey;

  [[nodiscard]] const float* row(int v) const { return grey.data() + std::ptrdiff_t{v} * width; }
  float* row(int v) { return grey.data() + std::ptrdiff_t{v} * width; }
};

Level level_of(const Canvas& canvas) {
  Level level{canvas.width(), canvas.height(), {}};
  level.grey.reserve(static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height));
  for (int v = 0; v < level.height; ++v)
    for (int u = 0; u < level.width; ++u) level.grey.push_back(canvas.at(u, v));
  return level;
}

Level half_as_wide(const Level& fine) {
  Level coarse{fine.width / 2, fine.height, std::vector<float>(fine.grey.size() / 2)};
  for (std::size_t i = 0; i < coarse.grey.size(); ++i)
    coarse.grey[i] = 0.5F * (fine.grey[2 * i] + fine.grey[2 * i + 1]);
  return coarse;
}

Level half_as_high(const Level& fine) {
  Level coarse{fine.width, fine.height / 2, std::vector<float>(fine.grey.size() / 2)};
  for (int v = 0; v < coarse.height; ++v) {
    const float* upper = fine.row(2 * v);
    const float* lower = fine.row(2 * v + 1);
    float* out = coarse.row(v);
    for (int u = 0; u < coarse.width; ++u) out[u] = 0.5F * (upper[u] + lower[u]);
  }
  return coarse;
}

std::vector<std::uint8_t> rounded(const Level& level) {
  std::vector<std::uint8_t> bytes(level.grey.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const float raised = std::clamp(level.grey[i], 0.0F, 255.0F) + 0.5F;  // several times faster than rint
    bytes[i] = static_cast<std::uint8_t>(raised);
  }
  return bytes;
}

void write(const Level& level, const kernels::MipmapLayout& layout, int lu, int lv, std::uint16_t* texels) {
  const std::vector<std::uint8_t> bytes = rounded(level);
  for (int v = 0; v < level.height; ++v) {
    const std::uint8_t* row = bytes.data() + std::ptrdiff_t{v} * level.width;
    const std::uint8_t* below = bytes.data() + std::ptrdiff_t{(v + 1) % level.height} * level.width;
    std::uint16_t* out =
        texels + std::ptrdiff_t{layout.first_row(lv) + v} * layout.pitch() + layout.first_column(lu);
    for (int u = 0; u < level.width; ++u) out[u] = static_cast<std::uint16_t>(row[u] | below[u] << 8);
    out[level.width] = out[0];
  }
}

}  // namespace

SummedMipmap::SummedMipmap(const Canvas& canvas) : layout_(layout_of(canvas)), texels_(layout_.size()) {
  Level wide = level_of(canvas);
  for (int lu = 0; lu < layout_.levels; ++lu) {
    write(wide, layout_, lu, 0, texels_.data());
    Level high = half_as_high(wide);
    for (int lv = 1; lv < layout_.levels; ++lv) {
      write(high, layout_, lu, lv, texels_.data());
      if (lv + 1 < layout_.levels) high = half_as_high(high);
    }
    if (lu + 1 < layout_.levels) wide = half_as_wide(wide);
  }
}

}  // namespace waymark::sim
