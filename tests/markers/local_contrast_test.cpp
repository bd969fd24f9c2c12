#include "waymark/markers/local_contrast.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"

namespace waymark::markers {
namespace {

int plain_contrast(const GreyImage& image, const Darkness& darkness, int u, int v) {
  const int half = darkness.window_px / 2, pixels = darkness.window_px * darkness.window_px;
  int sum = 0;
  for (int dv = -half; dv <= half; ++dv)
    for (int du = -half; du <= half; ++du)
      sum += image(std::clamp(u + du, 0, image.width_px() - 1), std::clamp(v + dv, 0, image.height_px() - 1));
  return pixels * (image(u, v) + darkness.margin_grey) - sum;
}

TEST(LocalContrast, IsThePixelLessTheMeanAroundIt) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (const auto& [width, height] : {std::pair(37, 21), std::pair(8, 3), std::pair(2, 30)}) {
    GreyImage image(width, height);
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u) image(u, v) = static_cast<std::uint8_t>(random.uniform(0.0, 256.0));
    for (const int window_px : {3, 5, 7, 9}) {
      const Darkness darkness{window_px, 7};
      ContrastMap map;
      measure_contrast(image, darkness, map);
      for (int v = 0; v < height; ++v)
        for (int u = 0; u < width; ++u)
          ASSERT_EQ(map.row(v)[u], plain_contrast(image, darkness, u, v))
              << window_px << ' ' << u << ' ' << v;
    }
  }
}

TEST(LocalContrast, HasABrightFrame) {
  ContrastMap map;
  measure_contrast(GreyImage(5, 4, 100), {.window_px = 9, .margin_grey = 0}, map);
  EXPECT_EQ(map.row(2)[2], 0);
  for (int v = -1; v <= 4; ++v)
    for (int u = -1; u <= 5; ++u) {
      const bool is_frame = u < 0 || v < 0 || u == 5 || v == 4;
      EXPECT_EQ(map.row(v)[u] > 0, is_frame) << u << ' ' << v;
    }
}

TEST(LocalContrast, HoldsTheLargestDifference) {
  GreyImage image(9, 9, 0);
  image(4, 4) = 255;
  ContrastMap map;
  measure_contrast(image, {.window_px = 9, .margin_grey = 99}, map);
  EXPECT_EQ(map.row(4)[4], 81 * (255 + 99) - 255);
}

}  // namespace
}  // namespace waymark::markers
