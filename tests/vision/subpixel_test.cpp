#include "waymark/vision/subpixel.hpp"

#include <cmath>
#include <tuple>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "smooth_texture.hpp"

namespace waymark::vision {
namespace {

struct Statistics {
  int found = 0;
  double mean_nees = 0.0;  ///< ideal 2
  double rms_error = 0.0;  ///< per axis, px
};

/// Patches of one image found in another one that is shifted by a part of a pixel, both with noise.
Statistics measure(int size, double grey_sigma, double contrast, std::uint64_t seed) {
  RandomStream random(seed, StreamPurpose::kWorld);
  Statistics s;
  constexpr int kTrials = 400;
  for (int i = 0; i < kTrials; ++i) {
    const test::SmoothTexture texture(random, contrast);
    const Eigen::Vector2d shift(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
    const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
    const GreyImage then = texture.seen(24, 24, I, Eigen::Vector2d::Zero(), grey_sigma, random);
    const GreyImage now = texture.seen(24, 24, I, -shift, grey_sigma, random);
    const auto peak = find_peak(now, *cut_patch(then, 12, 12, size), 12, 12, grey_sigma);
    if (!peak) continue;
    const Eigen::Vector2d error = peak->pixel - (Eigen::Vector2d(12.0, 12.0) + shift);
    ++s.found;
    s.mean_nees += error.dot(peak->R.inverse() * error);
    s.rms_error += error.squaredNorm() / 2.0;
  }
  s.mean_nees /= s.found;
  s.rms_error = std::sqrt(s.rms_error / s.found);
  return s;
}

TEST(Subpixel, ErrorIsWhatTheCovarianceClaimsWhereTextureIsWeak) {
  // Four standard deviations of the mean of 400 squared errors of two degrees are 0.4.
  for (const auto& [size, grey_sigma, contrast] :
       {std::tuple{9, 6.0, 12.0}, {9, 3.0, 4.0}, {16, 3.0, 4.0}, {16, 6.0, 4.0}}) {
    const Statistics s = measure(size, grey_sigma, contrast, 1);
    EXPECT_GT(s.found, 200);
    EXPECT_NEAR(s.mean_nees, 2.0, 0.6) << size << " " << grey_sigma << " " << contrast;
  }
}

TEST(Subpixel, ErrorIsATenthOfAPixelWhereTextureIsStrong) {
  for (const auto& [size, grey_sigma] : {std::pair{9, 1.0}, {16, 1.0}, {16, 3.0}, {16, 6.0}}) {
    const Statistics s = measure(size, grey_sigma, 12.0, 2);
    EXPECT_GT(s.found, 390);
    EXPECT_LT(s.rms_error, 0.1);
    EXPECT_LT(s.mean_nees, 2.0) << "no better is claimed than " << kMinPixelSigma;
  }
}

TEST(Subpixel, AChangeOfContrastLeavesNothing) {
  RandomStream random(4, StreamPurpose::kWorld);
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
  const test::SmoothTexture texture(random);
  const GreyImage then = texture.seen(40, 40, I, {0.0, 0.0}, 0.0, random);
  const auto left_at = [&](double contrast) {
    GreyImage now(40, 40);
    for (int v = 0; v < 40; ++v)
      for (int u = 0; u < 40; ++u)
        now(u, v) = static_cast<std::uint8_t>(std::lround(90.0 + contrast * (then(u, v) - 128.0)));
    return find_peak(now, *cut_patch(then, 20, 20, 16), 20, 20, 3.0)->zmssd;
  };
  EXPECT_LT(left_at(1.0), 100.0);
  EXPECT_LT(left_at(0.7), 100.0);  // of 256 pixels with rounding errors
  EXPECT_LT(left_at(0.6), 100.0);
  EXPECT_GT(left_at(0.3), 1000.0);
}

TEST(Subpixel, AnEdgeAndABlankWallHaveNoPeak) {
  GreyImage edge(40, 40), wall(40, 40, 128);
  for (int v = 0; v < 40; ++v)
    for (int u = 20; u < 40; ++u) edge(u, v) = 200;
  EXPECT_FALSE(find_peak(edge, *cut_patch(edge, 20, 20, 16), 20, 20, 2.0));
  EXPECT_FALSE(find_peak(wall, *cut_patch(wall, 20, 20, 16), 20, 20, 2.0));
}

TEST(Subpixel, AtTheBorderOfTheImageThereIsNone) {
  RandomStream random(3, StreamPurpose::kWorld);
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
  const GreyImage image = test::SmoothTexture(random).seen(40, 40, I, {0.0, 0.0}, 0.0, random);
  EXPECT_FALSE(find_peak(image, *cut_patch(image, 8, 20, 16), 8, 20, 2.0));
  EXPECT_TRUE(find_peak(image, *cut_patch(image, 9, 20, 16), 9, 20, 2.0));
}

}  // namespace
}  // namespace waymark::vision
