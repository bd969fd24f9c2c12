#include "waymark/core/grey_image.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(GreyImage, IsOneGreyUntilWritten) {
  GreyImage image(5, 3, 7);
  image(4, 2) = 9;
  EXPECT_EQ(image(0, 0), 7);
  EXPECT_EQ(image.data()[14], 9);
}

TEST(GreyImage, PartIsALookAtTheSamePixels) {
  GreyImage image(6, 4);
  for (int v = 0; v < 4; ++v)
    for (int u = 0; u < 6; ++u) image(u, v) = static_cast<std::uint8_t>(10 * v + u);
  const ImageView part = image.view().part(2, 1, 3, 2);
  EXPECT_EQ(part.width_px, 3);
  EXPECT_EQ(part.height_px, 2);
  EXPECT_EQ(part(0, 0), 12);
  EXPECT_EQ(part(2, 1), 24);
}

TEST(GreyImage, EmptyHasNoPixels) {
  EXPECT_TRUE(GreyImage().view().empty());
  EXPECT_FALSE(GreyImage(1, 1).view().empty());
}

}  // namespace
}  // namespace waymark
