#include "waymark/core/random.hpp"

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "waymark/core/chi2.hpp"

namespace waymark {
namespace {

using Block = std::array<std::uint32_t, 4>;

TEST(Philox, GivesTheKnownAnswersOfItsAuthors) {
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr std::uint32_t kOnes = 0xffffffff;
  EXPECT_EQ(philox4x32({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

std::vector<double> first_normals(RandomStream stream, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(stream.normal());
  return values;
}

TEST(RandomStream, SameArgumentsGiveTheSameNumbers) {
  const RandomStream stream(7, StreamPurpose::kMotion, 11, 13);
  EXPECT_EQ(first_normals(stream, 100), first_normals(RandomStream(7, StreamPurpose::kMotion, 11, 13), 100));
}

TEST(RandomStream, EveryArgumentCountsWithAllItsBits) {
  constexpr std::uint64_t kHigh = std::uint64_t{1} << 40;
  const std::vector<std::vector<double>> streams = {
      first_normals({7, StreamPurpose::kMotion, 11, 13}, 4),
      first_normals({8, StreamPurpose::kMotion, 11, 13}, 4),
      first_normals({7 + kHigh, StreamPurpose::kMotion, 11, 13}, 4),
      first_normals({7, StreamPurpose::kResampling, 11, 13}, 4),
      first_normals({7, StreamPurpose::kMotion, 12, 13}, 4),
      first_normals({7, StreamPurpose::kMotion, 11 + kHigh, 13}, 4),
      first_normals({7, StreamPurpose::kMotion, 11, 14}, 4),
      first_normals({7, StreamPurpose::kMotion, 11, 0x80000000U + 13}, 4)};
  for (std::size_t i = 0; i < streams.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(streams[i], streams[j]) << i << " " << j;
}

TEST(RandomStream, UniformsFillTheUnitIntervalEvenly) {
  constexpr int kDraws = 1 << 18;
  constexpr int kBins = 256;
  std::vector<int> counts(kBins, 0);
  RandomStream random(1, StreamPurpose::kSimulation);
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.uniform();
    ASSERT_TRUE(u >= 0.0 && u < 1.0) << u;
    ++counts[static_cast<std::size_t>(u * kBins)];
  }
  constexpr double kExpected = static_cast<double>(kDraws) / kBins;
  double statistic = 0.0;
  for (const int count : counts) statistic += (count - kExpected) * (count - kExpected) / kExpected;
  EXPECT_LT(statistic, chi2_quantile(1.0 - 1e-6, kBins - 1));
  EXPECT_GT(statistic, chi2_quantile(1e-6, kBins - 1));
}

TEST(RandomStream, UniformsKeepToTheirLimits) {
  RandomStream random(2, StreamPurpose::kSimulation);
  for (int i = 0; i < 10000; ++i) {
    const double u = random.uniform(-3.0, 5.0);
    EXPECT_TRUE(u >= -3.0 && u <= 5.0) << u;
  }
}

TEST(RandomStream, NormalsHaveTheMomentsOfTheStandardNormal) {
  constexpr int kDraws = 200000;
  RandomStream random(3, StreamPurpose::kMotion);
  double sums[5] = {};
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.normal();
    for (int power = 1; power <= 4; ++power) sums[power] += std::pow(x, power) / kDraws;
  }
  // Variances of x, x^2, x^3, x^4 are 1, 2, 15, 96.
  const auto five_sigma = [](double variance) { return 5.0 * std::sqrt(variance / kDraws); };
  EXPECT_NEAR(sums[1], 0.0, five_sigma(1.0));
  EXPECT_NEAR(sums[2], 1.0, five_sigma(2.0));
  EXPECT_NEAR(sums[3], 0.0, five_sigma(15.0));
  EXPECT_NEAR(sums[4], 3.0, five_sigma(96.0));
}

/// Correlation of the first normal of stream(i) with that of stream(i + 1); standard deviation 1/sqrt(draws).
double neighbour_correlation(const std::function<RandomStream(std::uint32_t)>& stream, std::uint32_t draws) {
  double sum = 0.0;
  for (std::uint32_t i = 0; i < draws; ++i) sum += stream(i).normal() * stream(i + 1).normal();
  return sum / draws;
}

TEST(RandomStream, NeighboursAreNotCorrelated) {
  constexpr std::uint32_t kDraws = 40000;
  const double five_sigma = 5.0 / std::sqrt(kDraws);
  const auto particle = [](std::uint32_t i) { return RandomStream(1, StreamPurpose::kMotion, 5, i); };
  const auto step = [](std::uint32_t i) { return RandomStream(1, StreamPurpose::kMotion, i, 5); };
  const auto seed = [](std::uint32_t i) { return RandomStream(i, StreamPurpose::kMotion, 5, 5); };
  EXPECT_LT(std::abs(neighbour_correlation(particle, kDraws)), five_sigma);
  EXPECT_LT(std::abs(neighbour_correlation(step, kDraws)), five_sigma);
  EXPECT_LT(std::abs(neighbour_correlation(seed, kDraws)), five_sigma);
}

TEST(RandomStream, PurposesAreNotCorrelated) {
  constexpr std::uint32_t kDraws = 40000;
  double sum = 0.0;
  for (std::uint32_t i = 0; i < kDraws; ++i)
    sum += RandomStream(1, StreamPurpose::kMotion, 2, i).normal() *
           RandomStream(1, StreamPurpose::kResampling, 2, i).normal();
  EXPECT_LT(std::abs(sum / kDraws), 5.0 / std::sqrt(kDraws));
}

TEST(RandomStream, TheTwoNormalsOfAPairAreIndependent) {
  constexpr int kDraws = 40000;
  RandomStream random(4, StreamPurpose::kMotion);
  double product = 0.0;
  double product_of_squares = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double a = random.normal();
    const double b = random.normal();
    product += a * b / kDraws;
    product_of_squares += (a * a - 1.0) * (b * b - 1.0) / kDraws;
  }
  EXPECT_NEAR(product, 0.0, 5.0 / std::sqrt(kDraws));
  EXPECT_NEAR(product_of_squares, 0.0, 5.0 * 2.0 / std::sqrt(kDraws));
}

}  // namespace
}  // namespace waymark
