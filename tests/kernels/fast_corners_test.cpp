#include "waymark/kernels/fast_corners.hpp"

#include "waymark/core/grey_image.hpp"

#include "kernels/kernel_support.hpp"

namespace waymark::kernels {
namespace {

/// Squares and noise: arcs of every length, brighter and darker.
GreyImage blocks(int width_px, int height_px, RandomStream& random) {
  GreyImage image(width_px, height_px, 90);
  for (int i = 0; i < width_px * height_px / 40; ++i) {
    const int u0 = static_cast<int>(random.uniform(-4.0, width_px)),
              v0 = static_cast<int>(random.uniform(-4.0, height_px));
    const int side = static_cast<int>(random.uniform(1.0, 9.0));
    const auto grey = static_cast<std::uint8_t>(random.uniform(0.0, 256.0));
    for (int v = std::max(v0, 0); v < std::min(v0 + side, height_px); ++v)
      for (int u = std::max(u0, 0); u < std::min(u0 + side, width_px); ++u) image(u, v) = grey;
  }
  return image;
}

class FastCorners : public test::OnEveryInstructionSet {};

WAYMARK_ON_EVERY_INSTRUCTION_SET(FastCorners);

TEST_P(FastCorners, ScoresAreThoseOfThePlainTestAtEveryArcAndCount) {
  int corners = 0;
  for (int arc = kMinFastArc; arc <= kMaxFastArc; ++arc) {
    for (const int count : {1, 2, 7, 15, 16, 17, 31, 33, 63, 64, 65, 130, 400}) {
      const GreyImage image = blocks(count + 6, 7, random_);
      std::vector<std::uint8_t> scores(static_cast<std::size_t>(count) + 1, 99);
      for (const std::uint8_t threshold : {std::uint8_t{1}, std::uint8_t{20}, std::uint8_t{60}}) {
        const std::uint8_t* first = image.view().pixel(3, 3);
        const bool any = fast_scores(first, image.stride(), static_cast<std::size_t>(count), threshold, arc,
                                     scores.data());
        bool expected_any = false;
        for (int k = 0; k < count; ++k) {
          const std::uint8_t expected = reference::fast_score(first + k, image.stride(), threshold, arc);
          ASSERT_EQ(scores[static_cast<std::size_t>(k)], expected)
              << "arc " << arc << ", " << k << " of " << count;
          expected_any |= expected != 0;
          corners += expected != 0;
        }
        EXPECT_EQ(any, expected_any);
        EXPECT_EQ(scores.back(), 99);
        std::vector<std::uint8_t> plain(scores.size(), 99);
        EXPECT_EQ(fast_scores_by(Instructions::kScalar)(
                      first, image.stride(), static_cast<std::size_t>(count), threshold, arc, plain.data()),
                  any);
        EXPECT_EQ(plain, scores);
      }
    }
  }
  EXPECT_GT(corners, 300);
}

TEST_P(FastCorners, ScoreIsTheLargestThresholdThatStillPasses) {
  const GreyImage image = blocks(200, 7, random_);
  std::vector<std::uint8_t> scores(194), at_score(194), above_score(194);
  const std::uint8_t* first = image.view().pixel(3, 3);
  ASSERT_TRUE(fast_scores(first, image.stride(), scores.size(), 10, 9, scores.data()));
  for (std::size_t k = 0; k < scores.size(); ++k) {
    if (scores[k] == 0) continue;
    EXPECT_GE(scores[k], 10);
    EXPECT_EQ(reference::fast_score(first + k, image.stride(), scores[k], 9), scores[k]);
    EXPECT_EQ(reference::fast_score(first + k, image.stride(), static_cast<std::uint8_t>(scores[k] + 1), 9),
              0);
  }
}

TEST_P(FastCorners, ExtremeContrastDoesNotOverflow) {
  GreyImage image(7, 7, 255);
  image(3, 3) = 0;
  std::uint8_t score = 0;
  EXPECT_TRUE(fast_scores(image.view().pixel(3, 3), 7, 1, 254, 12, &score));
  EXPECT_EQ(score, 254);
}

TEST_P(FastCorners, LargestAreThoseAboveAllEightNeighbours) {
  for (const int count : {1, 2, 15, 16, 17, 40, 64, 65, 200}) {
    GreyImage scores(count + 2, 3);
    for (int v = 0; v < 3; ++v) {
      for (int u = 0; u < count + 2; ++u) {
        const double draw = random_.uniform();  // many zeros, and many equal neighbours
        scores(u, v) =
            draw < 0.5 ? std::uint8_t{0} : static_cast<std::uint8_t>(250.0 + 6.0 * (draw - 0.5) * 2.0);
      }
    }
    std::vector<std::int32_t> places(static_cast<std::size_t>(count) + 1), expected;
    const ImageView view = scores;
    const std::size_t found = largest_scores(view.pixel(1, 0), view.pixel(1, 1), view.pixel(1, 2),
                                             static_cast<std::size_t>(count), places.data());
    for (int k = 0; k < count; ++k) {
      bool largest = true;
      for (int dv = -1; dv <= 1; ++dv)
        for (int du = -1; du <= 1; ++du)
          if ((du != 0 || dv != 0) && scores(k + 1 + du, 1 + dv) >= scores(k + 1, 1)) largest = false;
      if (largest) expected.push_back(k);
    }
    places.resize(found);
    EXPECT_EQ(places, expected) << count;
  }
}

}  // namespace
}  // namespace waymark::kernels
