#include "workbench/logs/deep_image.hpp"

#include <string>

#include <gmock/gmock.h>
#include <png.h>

#include "workbench/logs/image_file.hpp"

namespace waymark {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// As libpng writes samples of 16 bits; colours are multiplied by their opacity.
std::string png_bytes(int width_px, int height_px, png_uint_32 format,
                      const std::vector<std::uint16_t>& samples) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(width_px);
  png.height = static_cast<png_uint_32>(height_px);
  png.format = format;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
  png_alloc_size_t size = bytes.size();
  EXPECT_NE(png_image_write_to_memory(&png, bytes.data(), &size, 0, samples.data(), 0, nullptr), 0);
  bytes.resize(size);
  return bytes;
}

TEST(DeepImage, HasTheStoredValues) {
  const auto image = decode_deep_png(png_bytes(3, 2, PNG_FORMAT_LINEAR_Y, {0, 1, 256, 1023, 40000, 65535}));
  ASSERT_TRUE(image.ok()) << image.error().message;
  EXPECT_EQ(image->width_px, 3);
  EXPECT_EQ(image->height_px, 2);
  EXPECT_THAT(image->values, ElementsAre(0, 1, 256, 1023, 40000, 65535));
}

TEST(DeepImage, MixesColoursAndLaysThemOnBlack) {
  const auto colours = decode_deep_png(png_bytes(1, 1, PNG_FORMAT_LINEAR_RGB, {1000, 2000, 3000}));
  ASSERT_TRUE(colours.ok()) << colours.error().message;
  EXPECT_THAT(colours->values, ElementsAre((299 * 1000 + 587 * 2000 + 114 * 3000 + 500) / 1000));
  const auto thin = decode_deep_png(png_bytes(2, 1, PNG_FORMAT_LINEAR_Y_ALPHA, {10000, 20000, 700, 65535}));
  ASSERT_TRUE(thin.ok()) << thin.error().message;
  EXPECT_NEAR(thin->values[0], 10000, 1);
  EXPECT_EQ(thin->values[1], 700);
}

TEST(DeepImage, BecomesGreyByTheBitsInUse) {
  const std::string ten = png_bytes(2, 1, PNG_FORMAT_LINEAR_Y, {512, 1023});
  const auto alone = decode_image(ten, "a.png", ImageSize{2, 1});
  ASSERT_TRUE(alone.ok()) << alone.error().message;
  EXPECT_EQ((*alone)(0, 0), 128);
  EXPECT_EQ((*alone)(1, 0), 255);
  UsedBits bits;
  bits.shift(4000);
  EXPECT_EQ((*decode_image(ten, "a.png", {}, bits))(1, 0), 63) << "after a brighter one";
}

TEST(DeepImage, CutOffAnywhereIsAnError) {
  const std::string bytes = png_bytes(2, 2, PNG_FORMAT_LINEAR_Y, {512, 1023, 5, 6});
  for (std::size_t size = 0; size + 2 < bytes.size(); ++size) {
    EXPECT_FALSE(decode_deep_png(std::string_view(bytes).substr(0, size)).ok()) << size;
    EXPECT_FALSE(decode_image(std::string_view(bytes).substr(0, size), "cut").ok()) << size;
  }
  EXPECT_THAT(decode_deep_png(bytes.substr(0, 50)).error().message, HasSubstr("cut off"));
}

TEST(DeepImage, DamagedBytesAreNeverACrash) {
  const std::string bytes =
      png_bytes(8, 8, PNG_FORMAT_LINEAR_RGB_ALPHA, std::vector<std::uint16_t>(256, 999));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
    const auto image = decode_image(damaged, "damaged", ImageSize{8, 8});
    EXPECT_TRUE(image.ok() || !image.error().message.empty());
  }
}

}  // namespace
}  // namespace waymark
