#include "waymark/fastslam/particle_blocks.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace waymark::fastslam {
namespace {

std::array<double, 2> sum_roots(ParticleBlocks& blocks) {
  return blocks.sum([](std::size_t begin, std::size_t end) {
    std::array<double, 2> sum{};
    for (std::size_t i = begin; i < end; ++i) {
      sum[0] += std::sqrt(static_cast<double>(i));
      sum[1] += 1.0;
    }
    return sum;
  });
}

TEST(ParticleBlocks, VisitsEveryParticleOnce) {
  for (const int particles : {1, 255, 256, 257, 1000, 2049, 10'000, 300'001}) {
    ParticleBlocks blocks(particles, 2);
    std::vector<int> visits(static_cast<std::size_t>(particles));
    blocks.run([&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    EXPECT_EQ(visits, std::vector<int>(static_cast<std::size_t>(particles), 1));
  }
}

TEST(ParticleBlocks, SumsAllTermsToTheSameBitsOnAnyNumberOfThreads) {
  ParticleBlocks one(10'000, 1);
  ParticleBlocks three(10'000, 3);
  const auto expected = sum_roots(one);
  EXPECT_EQ(expected[1], 10'000.0);
  EXPECT_NEAR(expected[0], 2.0 / 3.0 * 1e6, 100.0);
  for (int round = 0; round < 50; ++round) EXPECT_EQ(sum_roots(three), expected);
}

}  // namespace
}  // namespace waymark::fastslam
