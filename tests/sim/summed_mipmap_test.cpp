#include "workbench/sim/summed_mipmap.hpp"

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"

namespace waymark::sim {
namespace {

double mean_of(const Canvas& canvas, int left, int top, int width, int height) {
  double sum = 0.0;
  for (int v = top; v < top + height; ++v)
    for (int u = left; u < left + width; ++u) sum += static_cast<double>(canvas.at(u, v));
  return sum / (width * height);
}

TEST(SummedMipmap, EveryElementIsTheMeanOfItsTexelsAndOfThoseBelow) {
  Canvas canvas(5, 4, 0.0F);
  RandomStream random(1, StreamPurpose::kWorld);
  for (int v = 0; v < 16; ++v)
    for (int u = 0; u < 32; ++u) canvas.at(u, v) = static_cast<float>(random.uniform(0.0, 255.0));
  const SummedMipmap map(canvas);
  const kernels::MipmapLayout& layout = map.layout();
  ASSERT_EQ(layout.levels, 5);
  for (int lv = 0; lv < layout.levels; ++lv) {
    for (int lu = 0; lu < layout.levels; ++lu) {
      const int width = 1 << lu, height = 1 << lv;
      for (int v = 0; v < layout.height(lv); ++v) {
        for (int u = 0; u <= layout.width(lu); ++u) {  // the first one again at the end
          const auto element =
              map.texels()[(layout.first_row(lv) + v) * layout.pitch() + layout.first_column(lu) + u];
          const int left = u % layout.width(lu) * width;
          ASSERT_NEAR(element & 255, mean_of(canvas, left, v * height, width, height), 0.51);
          ASSERT_NEAR(element >> 8, mean_of(canvas, left, (v + 1) * height, width, height), 0.51);
        }
      }
    }
  }
}

TEST(SummedMipmap, ClampsWhatIsPaintedBeyondBlackAndWhite) {
  Canvas canvas(2, 2, 300.0F);
  canvas.fill({0, 0, 4, 2}, -20.0F);
  const SummedMipmap map(canvas);
  EXPECT_EQ(map.texels()[0] & 255, 0);
  EXPECT_EQ(map.texels()[2 * map.layout().pitch()] & 255, 255);
}

}  // namespace
}  // namespace waymark::sim
