#include "waymark/kernels/zmssd.hpp"

#include <memory>

#include "waymark/core/grey_image.hpp"

#include "kernels/kernel_support.hpp"

namespace waymark::kernels {
namespace {

constexpr int kSizes[] = {8, 9, 11, 13, 16};

GreyImage noise(int width_px, int height_px, RandomStream& random) {
  GreyImage image(width_px, height_px);
  for (int v = 0; v < height_px; ++v)
    for (int u = 0; u < width_px; ++u) image(u, v) = static_cast<std::uint8_t>(random.uniform(0.0, 256.0));
  return image;
}

class Zmssd : public test::OnEveryInstructionSet {
 protected:
  // Windows side by side in an image that holds them and not one pixel more.
  void check(int size, int count) {
    const GreyImage patch = noise(size, size, random_);
    const GreyImage image = noise(count + size - 1, size, random_);
    // Exactly as much memory as there are pixels, so that a sanitizer sees every read beyond them.
    const std::size_t bytes = static_cast<std::size_t>(image.width_px()) * static_cast<std::size_t>(size);
    const auto pixels = std::make_unique<std::uint8_t[]>(bytes);
    std::copy_n(image.data(), bytes, pixels.get());
    std::vector<std::uint32_t> scores(static_cast<std::size_t>(count) + 1, 12345U);
    zmssd_row(make_zmssd_patch(patch.data(), size, size), pixels.get(), image.stride(),
              static_cast<std::size_t>(count), scores.data());
    for (int u = 0; u < count; ++u) {
      ASSERT_EQ(scores[static_cast<std::size_t>(u)],
                reference::zmssd(patch.data(), size, pixels.get() + u, image.stride(), size))
          << "size " << size << ", window " << u << " of " << count;
    }
    EXPECT_EQ(scores.back(), 12345U) << "written behind the last score";
  }
};

WAYMARK_ON_EVERY_INSTRUCTION_SET(Zmssd);

TEST_P(Zmssd, HasTheBitsOfThePlainFormulaAtEverySizeAndCount) {
  for (const int size : kSizes)
    for (int count = 1; count <= 140; ++count) check(size, count);
}

TEST_P(Zmssd, HoldsItsLargestValues) {
  // Half black and half white against the opposite: 256 * 256 * 255^2, the largest there is.
  GreyImage patch(16, 16), opposite(16, 16, 255);
  for (int v = 0; v < 16; ++v) {
    for (int u = 0; u < 8; ++u) {
      patch(u, v) = 255;
      opposite(u, v) = 0;
    }
  }
  std::uint32_t score = 0;
  zmssd_row(make_zmssd_patch(patch.data(), 16, 16), opposite.data(), 16, 1, &score);
  EXPECT_EQ(score, 256U * 256U * 255U * 255U);
}

TEST_P(Zmssd, IsBlindToAChangeOfBrightness) {
  const GreyImage dark = noise(16, 16, random_);
  GreyImage patch = dark, brighter = dark;
  for (int v = 0; v < 16; ++v) {
    for (int u = 0; u < 16; ++u) {
      patch(u, v) = dark(u, v) / 2;
      brighter(u, v) = static_cast<std::uint8_t>(dark(u, v) / 2 + 100);
    }
  }
  std::uint32_t score = 1;
  zmssd_row(make_zmssd_patch(patch.data(), 16, 16), brighter.data(), 16, 1, &score);
  EXPECT_EQ(score, 0U);
}

}  // namespace
}  // namespace waymark::kernels
