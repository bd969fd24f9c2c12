#include "waymark/vision/usable_image.hpp"

#include <gtest/gtest.h>

#include "smooth_texture.hpp"

namespace waymark::vision {
namespace {

GreyImage noisy(double grey, double grey_sigma) {
  RandomStream random(1, StreamPurpose::kWorld);
  GreyImage image(320, 240);
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u)
      image(u, v) = static_cast<std::uint8_t>(std::clamp(grey + grey_sigma * random.normal(), 0.0, 255.0));
  return image;
}

GreyImage textured() {
  RandomStream random(2, StreamPurpose::kWorld);
  return test::SmoothTexture(random, 6.0)
      .seen(320, 240, Eigen::Matrix2d::Identity(), {0.0, 0.0}, 3.0, random);
}

TEST(UsableImage, ShowsSomething) { EXPECT_TRUE(is_usable(textured(), 320, 240, 3.0)); }

TEST(UsableImage, IsNeitherBlackNorWhiteNorEvenlyGrey) {
  for (const double grey : {0.0, 8.0, 128.0, 250.0, 255.0})
    for (const double grey_sigma : {0.0, 3.0})
      EXPECT_FALSE(is_usable(noisy(grey, grey_sigma), 320, 240, 3.0)) << grey << " " << grey_sigma;
}

TEST(UsableImage, IsNotOverexposedInMostOfIt) {
  GreyImage image = textured();
  std::fill_n(image.data(), 320 * 90, std::uint8_t{255});
  EXPECT_TRUE(is_usable(image, 320, 240, 3.0));
  std::fill_n(image.data(), 320 * 150, std::uint8_t{255});
  EXPECT_FALSE(is_usable(image, 320, 240, 3.0));
}

TEST(UsableImage, HasTheSizeOfTheCamera) {
  EXPECT_FALSE(is_usable(textured(), 640, 480, 3.0));
  EXPECT_FALSE(is_usable(ImageView{}, 320, 240, 3.0));
  EXPECT_FALSE(is_usable(ImageView{}, 0, 0, 3.0));
}

}  // namespace
}  // namespace waymark::vision
