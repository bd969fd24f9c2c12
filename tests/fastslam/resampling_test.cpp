#include "waymark/fastslam/resampling.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"

namespace waymark::fastslam {
namespace {

std::vector<double> random_weights(RandomStream& random, std::size_t count) {
  std::vector<double> weights(count);
  // Log weights of spread 3: some particles carry much, many next to nothing, some nothing at all.
  for (double& w : weights) w = random.uniform() < 0.1 ? 0.0 : std::exp(3.0 * random.normal());
  weights.front() = std::max(weights.front(), 1e-3);
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& w : weights) w /= total;
  return weights;
}

std::vector<std::int32_t> ancestors_of(const std::vector<double>& weights, double u) {
  ParticleBlocks blocks(static_cast<int>(weights.size()));
  Resampling resampling(blocks);
  const auto ancestors = resampling.choose_ancestors(weights, u);
  return {ancestors.begin(), ancestors.end()};
}

std::vector<int> offspring_of(const std::vector<double>& weights, double u) {
  std::vector<int> offspring(weights.size());
  for (const auto ancestor : ancestors_of(weights, u)) ++offspring.at(static_cast<std::size_t>(ancestor));
  return offspring;
}

TEST(EffectiveParticles, CountsEquallyLikelyOnes) {
  EXPECT_DOUBLE_EQ(effective_particles(std::vector<double>(8, 0.125)), 8.0);
  EXPECT_DOUBLE_EQ(effective_particles(std::vector<double>{0.0, 1.0, 0.0}), 1.0);
  EXPECT_DOUBLE_EQ(effective_particles(std::vector<double>{0.5, 0.0, 0.5}), 2.0);
}

TEST(ChooseAncestors, GivesFloorOrCeilOfTheExpectedOffspring) {
  RandomStream random(1, StreamPurpose::kResampling);
  for (const std::size_t count : {1U, 2U, 17U, 256U, 1000U}) {
    for (int round = 0; round < 50; ++round) {
      const auto weights = random_weights(random, count);
      const auto offspring = offspring_of(weights, random.uniform());
      for (std::size_t i = 0; i < count; ++i) {
        const double expected = static_cast<double>(count) * weights[i];
        EXPECT_GE(offspring[i], std::floor(expected - 1e-9));
        EXPECT_LE(offspring[i], std::ceil(expected + 1e-9));
      }
    }
  }
}

TEST(ChooseAncestors, IsUnbiased) {
  RandomStream random(2, StreamPurpose::kResampling);
  const auto weights = random_weights(random, 20);
  constexpr int kDraws = 20'000;
  std::vector<double> mean(weights.size());
  // Evenly spread u instead of random ones: what remains is the rounding of each count, at most 1 / kDraws.
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto offspring = offspring_of(weights, (draw + 0.5) / kDraws);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += offspring[i] / static_cast<double>(kDraws);
  }
  for (std::size_t i = 0; i < mean.size(); ++i) EXPECT_NEAR(mean[i], 20.0 * weights[i], 2.0 / kDraws);
}

TEST(ChooseAncestors, KeepsEveryParentInItsOwnPlace) {
  RandomStream random(3, StreamPurpose::kResampling);
  for (int round = 0; round < 200; ++round) {
    const auto ancestors = ancestors_of(random_weights(random, 64), random.uniform());
    for (const auto ancestor : ancestors)
      EXPECT_EQ(ancestors.at(static_cast<std::size_t>(ancestor)), ancestor);
  }
}

TEST(ChooseAncestors, NeverRevivesADeadParticleAtTheExtremesOfU) {
  // 0.1 is not a binary number: the prefix sum of ten of them is below 1.
  std::vector<double> weights(10, 0.1);
  weights.insert(weights.end(), 5, 0.0);
  weights.insert(weights.begin(), 0.0);
  for (const double u : {0.0, 0.5, std::nextafter(1.0, 0.0)}) {
    const auto offspring = offspring_of(weights, u);
    EXPECT_EQ(offspring.front(), 0) << u;
    for (std::size_t i = 11; i < offspring.size(); ++i) EXPECT_EQ(offspring[i], 0) << u;
  }
}

TEST(ChooseAncestors, EachHasFloorOrCeilOfItsShareAndKeepsItsPlace) {
  RandomStream random(4, StreamPurpose::kResampling);
  for (const std::size_t count : {1U, 300U, 700U, 1000U}) {
    ParticleBlocks blocks(static_cast<int>(count));
    Resampling resampling(blocks);
    const auto weights = random_weights(random, count);
    const auto ancestors = resampling.choose_ancestors(weights, random.uniform());
    ASSERT_EQ(ancestors.size(), count);
    std::vector<int> offspring(count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto ancestor = static_cast<std::size_t>(ancestors[i]);
      ++offspring.at(ancestor);
      EXPECT_EQ(ancestors[ancestor], ancestors[i]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double expected = static_cast<double>(count) * weights[i];
      EXPECT_GE(offspring[i], std::floor(expected - 1e-9));
      EXPECT_LE(offspring[i], std::ceil(expected + 1e-9));
    }
  }
}

TEST(ChooseAncestors, IsTheSameOnSeveralThreads) {
  RandomStream random(5, StreamPurpose::kResampling);
  const auto weights = random_weights(random, 5000);
  ParticleBlocks one(5000, 1);
  ParticleBlocks two(5000, 2);
  Resampling on_one(one);
  Resampling on_two(two);
  const auto a = on_one.choose_ancestors(weights, 0.3);
  const auto b = on_two.choose_ancestors(weights, 0.3);
  EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
}

TEST(ChooseAncestors, EqualWeightsChangeNothing) {
  const auto ancestors = ancestors_of(std::vector<double>(100, 0.01), 0.3);
  for (std::int32_t i = 0; i < 100; ++i) EXPECT_EQ(ancestors[static_cast<std::size_t>(i)], i);
}

}  // namespace
}  // namespace waymark::fastslam
