#include "workbench/sim/canvas.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace waymark::sim {
namespace {

TEST(Canvas, RepeatsBeyondItsSides) {
  Canvas canvas(4, 3, 10.0F);
  canvas.fill({14, 7, 4, 2}, 90.0F);
  EXPECT_EQ(canvas.at(15, 7), 90.0F);
  EXPECT_EQ(canvas.at(1, 0), 90.0F);
  EXPECT_EQ(canvas.at(-1, -1), 90.0F);
  EXPECT_EQ(canvas.at(2, 0), 10.0F);
}

TEST(Canvas, ADiscHasItsAreaAndASmoothRim) {
  Canvas canvas(6, 6, 0.0F);
  canvas.disc(31.3F, 30.6F, 12.0F, 1.0F);
  double sum = 0.0;
  for (int v = 0; v < 64; ++v)
    for (int u = 0; u < 64; ++u) sum += static_cast<double>(canvas.at(u, v));
  EXPECT_NEAR(sum, std::acos(-1.0) * 144.0, 3.0);
  EXPECT_EQ(canvas.at(31, 30), 1.0F);
  EXPECT_EQ(canvas.at(31, 45), 0.0F);
}

TEST(Canvas, GrainIsSmoothOverItsSizeAndKeepsTheMean) {
  Canvas canvas(8, 8, 100.0F);
  RandomStream random(1, StreamPurpose::kWorld);
  canvas.add_grain(16, 16, 20.0F, random);
  double sum = 0.0;
  float largest_step = 0.0F, largest = 0.0F;
  for (int v = 0; v < 256; ++v) {
    for (int u = 0; u < 256; ++u) {
      sum += static_cast<double>(canvas.at(u, v)) - 100.0;
      largest = std::max(largest, std::abs(canvas.at(u, v) - 100.0F));
      largest_step = std::max({largest_step, std::abs(canvas.at(u, v) - canvas.at(u + 1, v)),
                               std::abs(canvas.at(u, v) - canvas.at(u, v + 1))});
    }
  }
  EXPECT_NEAR(sum / 65536.0, 0.0, 3.0);  // 256 knots of +-20: 0.7
  EXPECT_LE(largest, 20.0F);
  EXPECT_GT(largest, 15.0F);
  EXPECT_LE(largest_step, 40.0F / 16.0F + 1e-3F);
}

}  // namespace
}  // namespace waymark::sim
