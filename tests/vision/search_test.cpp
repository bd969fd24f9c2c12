#include "waymark/vision/search.hpp"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/poses.hpp"

#include "smooth_texture.hpp"

namespace waymark::vision {
namespace {

const Eigen::Matrix2d kSame = Eigen::Matrix2d::Identity();

Eigen::Matrix2d random_ellipse(RandomStream& random) {
  return test::random_covariance<2>(random, random.uniform(1.0, 60.0));
}

GreyImage texture(std::uint64_t seed, double grey_sigma = 0.0) {
  RandomStream random(seed, StreamPurpose::kWorld);
  return test::SmoothTexture(random).seen(160, 120, kSame, {0.0, 0.0}, grey_sigma, random);
}

TEST(EllipseRows, HoldThePixelsInsideTheEllipseAndNoOthers) {
  RandomStream random(1, StreamPurpose::kWorld);
  const GreyImage image(160, 120);
  EllipseRows ellipse;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector2d centre(random.uniform(-20.0, 180.0), random.uniform(-20.0, 140.0));
    const Eigen::Matrix2d S = random_ellipse(random), W = S.inverse();
    const int size = i % 2 == 0 ? 16 : 9;
    find_ellipse_rows(image, centre, S, 9.21, size, ellipse);
    std::int64_t inside = 0;
    for (int v = 0; v < 120; ++v) {
      for (int u = 0; u < 160; ++u) {
        const Eigen::Vector2d d = Eigen::Vector2d(u, v) - centre;
        const bool expected = d.dot(W * d) <= 9.21 && patch_fits(image, u, v, size);
        const int k = v - ellipse.first_row;
        const bool in_rows = k >= 0 && k < static_cast<int>(ellipse.rows.size());
        const auto row = in_rows ? ellipse.rows[static_cast<std::size_t>(k)] : kernels::WindowRow{};
        ASSERT_EQ(u >= row.first && u < row.first + row.count, expected) << u << " " << v;
        inside += expected;
      }
    }
    EXPECT_EQ(ellipse.windows, inside);
  }
}

/// The best window by the formulas as printed, over the whole image.
Match plain_search(const GreyImage& image, const Patch& patch, const Eigen::Vector2d& predicted,
                   const Eigen::Matrix2d& S, const SearchOptions& o) {
  Match best;
  best.score = 1e300;
  for (int v = 8; v <= image.height_px() - 8; ++v) {
    for (int u = 8; u <= image.width_px() - 8; ++u) {
      const Eigen::Vector2d d = Eigen::Vector2d(u, v) - predicted;
      const double distance2 = d.dot(S.inverse() * d);
      if (distance2 > 9.2103) continue;
      const auto window = *cut_patch(image, u, v, 16);
      const double zmssd =
          kernels::reference::zmssd(patch.pixels.data(), 16, window.pixels.data(), 16, 16) / 256.0;
      const double score = o.match == MatchScore::kMap
                               ? zmssd / (4.0 * o.grey_sigma * o.grey_sigma) + 0.5 * distance2
                               : zmssd / std::exp(-0.5 * distance2);
      if (score < best.score) best = {u, v, zmssd, distance2, score};
    }
  }
  return best;
}

TEST(Search, FindsWhatThePlainFormulaFindsByBothScores) {
  RandomStream random(2, StreamPurpose::kWorld);
  const GreyImage image = texture(3, 2.0);
  for (const MatchScore match : {MatchScore::kMap, MatchScore::kArticle}) {
    const SearchOptions options{.probability = 0.99, .max_windows = 160 * 120, .match = match};
    Search search(options);
    for (int i = 0; i < 40; ++i) {
      const Patch patch = *cut_patch(texture(100 + static_cast<std::uint64_t>(i % 5)), 60, 60, 16);
      const Eigen::Vector2d predicted(random.uniform(20.0, 140.0), random.uniform(20.0, 100.0));
      const Eigen::Matrix2d S = random_ellipse(random);
      const auto found = search.find(image, patch, predicted, S);
      ASSERT_TRUE(found);
      const Match plain = plain_search(image, patch, predicted, S, options);
      EXPECT_EQ(std::pair(found->u, found->v), std::pair(plain.u, plain.v)) << i;
      EXPECT_NEAR(found->score, plain.score, 1e-9 * plain.score);
      EXPECT_DOUBLE_EQ(found->zmssd, plain.zmssd);
    }
  }
}

TEST(Search, FindsAPatchWhereItWasCut) {
  RandomStream random(4, StreamPurpose::kWorld);
  const GreyImage then = texture(5, 0.0), now = texture(5, 3.0);
  Search search;
  for (int i = 0; i < 100; ++i) {
    const int u = static_cast<int>(random.uniform(20.0, 140.0)),
              v = static_cast<int>(random.uniform(20.0, 100.0));
    const auto found = search.find(
        now, *cut_patch(then, u, v, 16),
        Eigen::Vector2d(u, v) + 3.0 * Eigen::Vector2d(random.normal(), random.normal()), 16.0 * kSame);
    ASSERT_TRUE(found);
    EXPECT_EQ(std::pair(found->u, found->v), std::pair(u, v));
    EXPECT_TRUE(found->accepted);
  }
}

TEST(Search, AcceptsTheLandmarkAndNotAnotherPlace) {
  const GreyImage here = texture(6, 3.0), elsewhere = texture(7, 3.0);
  Search search;
  const Patch patch = *cut_patch(here, 80, 60, 16);
  EXPECT_TRUE(search.find(texture(6, 3.0), patch, {80.0, 60.0}, 4.0 * kSame)->accepted);
  EXPECT_FALSE(search.find(elsewhere, patch, {80.0, 60.0}, 4.0 * kSame)->accepted);
}

TEST(Search, IsNothingWhereNoWindowFitsOrThereIsNoCovariance) {
  const GreyImage image = texture(8);
  Search search;
  const Patch patch = *cut_patch(image, 80, 60, 16);
  EXPECT_FALSE(search.find(image, patch, {-50.0, 60.0}, 4.0 * kSame));
  EXPECT_FALSE(search.find(image, patch, {80.0, 60.0}, Eigen::Matrix2d::Zero()));
  EXPECT_FALSE(search.find(image, patch, {80.0, 60.0}, kSame * std::nan("")));
  EXPECT_FALSE(search.find(image, patch, {std::nan(""), 60.0}, kSame));
  EXPECT_FALSE(search.find(GreyImage(10, 10), patch, {5.0, 5.0}, kSame));
}

TEST(Search, OfAVastEllipseLooksAtCornersAndStaysWithinItsBound) {
  // Squares on a wall: corners that FAST finds.
  GreyImage image(160, 120, 100);
  RandomStream random(9, StreamPurpose::kWorld);
  for (int i = 0; i < 25; ++i) {
    const int u0 = static_cast<int>(random.uniform(5.0, 140.0)),
              v0 = static_cast<int>(random.uniform(5.0, 100.0));
    const auto grey = static_cast<std::uint8_t>(random.uniform(0.0, 256.0));
    for (int v = v0; v < v0 + 14; ++v)
      for (int u = u0; u < u0 + 14; ++u) image(u, v) = grey;
  }
  for (int v = 0; v < 120; ++v)  // so that no two pixels of a corner score the same
    for (int u = 0; u < 160; ++u)
      image(u, v) =
          static_cast<std::uint8_t>(image(u, v) * 9 / 10 + static_cast<int>(random.uniform(0.0, 6.0)));
  CornerDetector detector({.threshold = 15, .arc = 9});
  Search search({.max_windows = 900});
  int tried = 0;
  for (const Corner& c : std::vector<Corner>(detector.detect(image))) {
    if (!patch_fits(image, c.u, c.v, 16, 1)) continue;
    const auto found = search.find(image, *cut_patch(image, c.u, c.v, 16), {80.0, 60.0}, 1600.0 * kSame);
    ASSERT_TRUE(found);
    EXPECT_LE(search.windows(), 900);
    EXPECT_EQ(found->zmssd, 0.0) << c.u << " " << c.v;
    ++tried;
  }
  EXPECT_GT(tried, 10);
}

TEST(Search, AllocatesNothingOnceItHasGrown) {
  const GreyImage image = texture(10);
  Search search;
  const Patch patch = *cut_patch(image, 80, 60, 16);
  const auto run = [&] {
    static_cast<void>(search.find(image, patch, {80.0, 60.0}, 30.0 * kSame));
    static_cast<void>(search.find(image, patch, {80.0, 60.0}, 3000.0 * kSame));
  };
  run();
  const test::AllocationCount count;
  run();
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::vision
