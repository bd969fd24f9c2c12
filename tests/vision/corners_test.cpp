#include "waymark/vision/corners.hpp"

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"
#include "waymark/kernels/fast_corners.hpp"

#include "photographs.hpp"

namespace waymark::vision {
namespace {

GreyImage blocks(int width_px, int height_px, std::uint64_t seed) {
  RandomStream random(seed, StreamPurpose::kWorld);
  GreyImage image(width_px, height_px, 90);
  for (int i = 0; i < width_px * height_px / 60; ++i) {
    const int u0 = static_cast<int>(random.uniform(0.0, width_px)),
              v0 = static_cast<int>(random.uniform(0.0, height_px));
    const int side = static_cast<int>(random.uniform(2.0, 12.0));
    const auto grey = static_cast<std::uint8_t>(random.uniform(0.0, 256.0));
    for (int v = v0; v < std::min(v0 + side, height_px); ++v)
      for (int u = u0; u < std::min(u0 + side, width_px); ++u) image(u, v) = grey;
  }
  return image;
}

/// Scores of all pixels by the plain test, then those above all neighbours.
std::vector<Corner> plain_corners(const GreyImage& image, const CornerOptions& options) {
  GreyImage scores(image.width_px(), image.height_px());
  for (int v = 3; v < image.height_px() - 3; ++v)
    for (int u = 3; u < image.width_px() - 3; ++u)
      scores(u, v) =
          kernels::reference::fast_score(image.view().pixel(u, v), image.stride(),
                                         static_cast<std::uint8_t>(options.threshold), options.arc);
  const auto is_largest = [&](int u, int v) {
    for (int dv = -1; dv <= 1; ++dv)
      for (int du = -1; du <= 1; ++du)
        if ((du != 0 || dv != 0) && scores(u + du, v + dv) >= scores(u, v)) return false;
    return true;
  };
  std::vector<Corner> corners;
  for (int v = 3; v < image.height_px() - 3; ++v)
    for (int u = 3; u < image.width_px() - 3; ++u)
      if (is_largest(u, v)) corners.push_back({u, v, scores(u, v)});
  return corners;
}

TEST(Corners, AreThoseOfThePlainTest) {
  const GreyImage image = blocks(211, 97, 1);
  for (int arc = 9; arc <= 12; ++arc) {
    const CornerOptions options{.threshold = 15, .arc = arc};
    CornerDetector detector(options);
    const auto& corners = detector.detect(image);
    EXPECT_GT(corners.size(), 20U);
    EXPECT_EQ(corners, plain_corners(image, options)) << "arc " << arc;
  }
}

TEST(Corners, OfACellAreThoseOfTheImageThatLieInIt) {
  const GreyImage image = blocks(160, 120, 2);
  CornerDetector detector({.threshold = 15, .arc = 9});
  const std::vector<Corner> all = detector.detect(image);
  RandomStream random(3, StreamPurpose::kWorld);
  for (int i = 0; i < 200; ++i) {
    const PixelRect cell{
        static_cast<int>(random.uniform(-20.0, 170.0)), static_cast<int>(random.uniform(-20.0, 130.0)),
        static_cast<int>(random.uniform(0.0, 100.0)), static_cast<int>(random.uniform(0.0, 80.0))};
    std::vector<Corner> inside;
    for (const Corner& c : all)
      if (c.u >= cell.u && c.u < cell.u + cell.width_px && c.v >= cell.v && c.v < cell.v + cell.height_px)
        inside.push_back(c);
    EXPECT_EQ(detector.detect(image, cell), inside);
  }
}

TEST(Corners, OfAOneGreyOrTinyImageAreNone) {
  CornerDetector detector;
  EXPECT_TRUE(detector.detect(GreyImage(320, 240, 0)).empty());
  EXPECT_TRUE(detector.detect(GreyImage(320, 240, 255)).empty());
  EXPECT_TRUE(detector.detect(GreyImage(6, 6, 9)).empty());
  EXPECT_TRUE(detector.detect(GreyImage()).empty());
}

TEST(Corners, AreAsManyAsCountedInPhotographs) {
  WAYMARK_REQUIRE_DATA("gray-images");
  // FAST-9 at threshold 20, as the collection's README has them.
  CornerDetector detector({.threshold = 20, .arc = 9});
  EXPECT_NEAR(static_cast<double>(detector.detect(test::photograph("graf1.png")).size()), 2548.0, 5.0);
  EXPECT_EQ(detector.detect(test::photograph("box.png")).size(), 1814U);
}

}  // namespace
}  // namespace waymark::vision
