#include "waymark/kernels/zmssd.hpp"

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
  // Windows in an image that holds them and not one pixel more.
  void check(int size, const std::vector<WindowRow>& rows) {
    int last = 0;
    std::size_t windows = 0;
    for (const WindowRow& row : rows) {
      last = std::max(last, row.first + row.count);
      windows += static_cast<std::size_t>(row.count);
    }
    const GreyImage patch = noise(size, size, random_);
    const GreyImage image = noise(last + size - 1, static_cast<int>(rows.size()) + size - 1, random_);
    std::vector<std::uint32_t> scores(windows + 1, 12345U);
    zmssd_search(make_zmssd_patch(patch.data(), size, size), image.data(), image.stride(), rows.data(),
                 rows.size(), scores.data());
    std::size_t at = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      for (int u = rows[k].first; u < rows[k].first + rows[k].count; ++u, ++at) {
        const std::uint8_t* window = image.view().pixel(u, static_cast<int>(k));
        ASSERT_EQ(scores[at], reference::zmssd(patch.data(), size, window, image.stride(), size))
            << "size " << size << ", window " << u << " of row " << k << " of " << rows.size();
      }
    }
    EXPECT_EQ(scores.back(), 12345U) << "written behind the last score";
    std::vector<std::uint32_t> plain(windows + 1, 12345U);
    zmssd_search_by(Instructions::kScalar)(make_zmssd_patch(patch.data(), size, size), image.data(),
                                           image.stride(), rows.data(), rows.size(), plain.data());
    EXPECT_EQ(plain, scores);
  }

  int draw(int low, int high) { return static_cast<int>(random_.uniform(low, high + 1)); }
};

WAYMARK_ON_EVERY_INSTRUCTION_SET(Zmssd);

TEST_P(Zmssd, HasTheBitsOfThePlainFormulaAtEverySizeAndCount) {
  for (const int size : kSizes)
    for (int count = 1; count <= 140; ++count) check(size, {{0, count}});
}

TEST_P(Zmssd, HasTheBitsOfThePlainFormulaInSearchesOfAnyShape) {
  for (int i = 0; i < 100; ++i) {
    std::vector<WindowRow> rows(static_cast<std::size_t>(draw(1, 60)));
    const int widest = draw(1, i % 2 == 0 ? 20 : 150);
    const double empty = random_.uniform(0.0, 0.9);
    for (WindowRow& row : rows)
      if (random_.uniform() >= empty) row = {draw(0, widest), draw(0, widest)};
    for (const int size : kSizes) check(size, rows);
  }
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
  const WindowRow row{0, 1};
  zmssd_search(make_zmssd_patch(patch.data(), 16, 16), opposite.data(), 16, &row, 1, &score);
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
  const WindowRow row{0, 1};
  zmssd_search(make_zmssd_patch(patch.data(), 16, 16), brighter.data(), 16, &row, 1, &score);
  EXPECT_EQ(score, 0U);
}

}  // namespace
}  // namespace waymark::kernels
