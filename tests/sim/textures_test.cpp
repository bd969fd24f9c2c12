#include "workbench/sim/textures.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace waymark::sim {
namespace {

struct Grey {
  double mean = 0.0;
  double sigma = 0.0;
};

Grey grey_of(const Canvas& canvas) {
  double sum = 0.0, squares = 0.0;
  for (int v = 0; v < canvas.height(); ++v)
    for (int u = 0; u < canvas.width(); ++u) {
      const double grey = canvas.at(u, v);
      sum += grey;
      squares += grey * grey;
    }
  const double n = static_cast<double>(canvas.width()) * canvas.height();
  return {sum / n, std::sqrt(squares / n - sum / n * sum / n)};
}

// Neither dark nor glaring, and with contrast to find corners in.
TEST(Textures, HaveMiddleGreyAndContrast) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    RandomStream random(seed, StreamPurpose::kWorld);
    for (const Canvas& canvas : {paint_wall(10.0, random), paint_floor(random), paint_ceiling(random),
                                 paint_furniture(random), paint_clothes(random)}) {
      const Grey grey = grey_of(canvas);
      EXPECT_GT(grey.mean, 40.0);
      EXPECT_LT(grey.mean, 210.0);
      EXPECT_GT(grey.sigma, 10.0);
    }
  }
}

TEST(Textures, AWallIsAsLongAsItIsWantedUpToTwentyMetres) {
  RandomStream random(1, StreamPurpose::kWorld);
  EXPECT_EQ(paint_wall(3.0, random).width(), 1024);
  EXPECT_EQ(paint_wall(10.0, random).width(), 2048);
  EXPECT_EQ(paint_wall(100.0, random).width(), 4096);
}

}  // namespace
}  // namespace waymark::sim
