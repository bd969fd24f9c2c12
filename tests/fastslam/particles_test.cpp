#include "waymark/fastslam/particles.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"
#include "waymark/fastslam/resampling.hpp"

namespace waymark::fastslam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

double sum_of_weights(const Particles& p) {
  return std::accumulate(p.weights().begin(), p.weights().end(), 0.0);
}

double effective(const Particles& p) { return effective_particles(p.weights()); }

void set_log_weights(Particles& p, const std::vector<double>& values) {
  std::ranges::copy(values, p.log_weights().begin());
}

TEST(Particles, EstimateIsCircularAndWeighted) {
  Particles particles(3, {0.0, 0.0, kPi - 0.1});
  ParticleBlocks blocks(3);
  particles.set_pose(1, {2.0, 0.0, -kPi + 0.1});
  set_log_weights(particles, {std::log(0.5), std::log(0.5), -kInfinity});
  ASSERT_TRUE(normalise_weights(particles, blocks));
  const PoseEstimate mean = estimate(particles, blocks);
  EXPECT_NEAR(std::abs(mean.T_world_robot.theta_rad), kPi, 1e-12);
  EXPECT_NEAR(mean.T_world_robot.x_m, 1.0, 1e-12);
  EXPECT_NEAR(mean.covariance(2, 2), 0.01, 1e-12);
  EXPECT_NEAR(mean.covariance(0, 0), 1.0, 1e-12);
  EXPECT_NEAR(mean.covariance(0, 2), 0.1, 1e-12);
}

TEST(Particles, WeightsOfVeryUnlikelyParticlesKeepTheirProportions) {
  Particles particles(3, {});
  ParticleBlocks blocks(3);
  set_log_weights(particles, {-1e6, -1e6 + std::log(3.0), -2e6});
  ASSERT_TRUE(normalise_weights(particles, blocks));
  EXPECT_NEAR(particles.weights()[0], 0.25, 1e-9);
  EXPECT_NEAR(particles.weights()[1], 0.75, 1e-9);
  EXPECT_EQ(particles.weights()[2], 0.0);
}

TEST(Particles, AParticleWithoutAFiniteWeightDies) {
  Particles particles(4, {});
  ParticleBlocks blocks(4);
  set_log_weights(particles, {kNoNumber, kInfinity, -3.0, -kInfinity});
  ASSERT_TRUE(normalise_weights(particles, blocks));
  EXPECT_EQ(particles.weights()[2], 1.0);
  EXPECT_EQ(sum_of_weights(particles), 1.0);
}

TEST(Particles, ASetThatLostAllWeightStartsAgainEvenly) {
  Particles particles(4, {});
  ParticleBlocks blocks(4);
  set_log_weights(particles, {kNoNumber, kInfinity, -kInfinity, -kInfinity});
  EXPECT_FALSE(normalise_weights(particles, blocks));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(particles.weights()[i], 0.25);
  EXPECT_TRUE(normalise_weights(particles, blocks));
}

TEST(Particles, TemperingKeepsTheOrderAndTheEffectiveNumber) {
  constexpr int kCount = 1000;
  Particles particles(kCount, {});
  ParticleBlocks blocks(kCount);
  RandomStream random(3, StreamPurpose::kWorld);
  for (const double spread : {10.0, 1e3, 1e9}) {
    for (std::size_t i = 0; i < kCount; ++i) particles.log_weights()[i] = spread * random.normal();
    ASSERT_TRUE(normalise_weights(particles, blocks));
    const auto best = std::ranges::max_element(particles.weights());
    temper_weights(particles, 100.0, blocks);
    EXPECT_GE(effective(particles), 100.0 * (1.0 - 1e-9)) << spread;
    EXPECT_LT(effective(particles), 105.0) << spread;
    EXPECT_NEAR(sum_of_weights(particles), 1.0, 1e-12);
    EXPECT_EQ(std::ranges::max_element(particles.weights()), best);
  }
}

TEST(Particles, TemperingLeavesAHealthySetAlone) {
  Particles particles(3, {});
  ParticleBlocks blocks(3);
  set_log_weights(particles, {0.0, -1.0, -2.0});
  ASSERT_TRUE(normalise_weights(particles, blocks));
  const double before = particles.weights()[2];
  temper_weights(particles, 1.2, blocks);
  EXPECT_EQ(particles.weights()[2], before);
}

/// Particles at (i, 0, 0).
Particles in_a_row(int count) {
  Particles particles(count, {});
  for (int i = 0; i < count; ++i) particles.set_pose(i, {static_cast<double>(i), 0.0, 0.0});
  return particles;
}

TEST(Particles, DescendantsAreCopiesAndWeighTheSame) {
  Particles particles = in_a_row(4);
  ParticleBlocks blocks(4);
  particles.replace_by_ancestors(std::vector<std::int32_t>{0, 2, 2, 2}, blocks);
  EXPECT_EQ(particles.pose(0).x_m, 0.0);
  for (const int i : {1, 2, 3}) EXPECT_EQ(particles.pose(i).x_m, 2.0);
  EXPECT_EQ(particles.weights()[3], 0.25);
}

TEST(Particles, ASetMayShrinkAndGrowAgain) {
  Particles particles = in_a_row(20);
  ParticleBlocks blocks(20);
  particles.replace_by_ancestors(std::vector<std::int32_t>{0, 19, 7}, blocks);
  ASSERT_EQ(particles.count(), 3);
  EXPECT_EQ(particles.pose(1).x_m, 19.0);
  EXPECT_EQ(particles.pose(2).x_m, 7.0);
  EXPECT_NEAR(estimate(particles, blocks).T_world_robot.x_m, 26.0 / 3.0, 1e-12);
  particles.replace_by_ancestors(std::vector<std::int32_t>{0, 1, 2, 1, 1}, blocks);
  ASSERT_EQ(particles.count(), 5);
  EXPECT_EQ(particles.pose(4).x_m, 19.0);
  EXPECT_EQ(particles.weights()[4], 0.2);
}

}  // namespace
}  // namespace waymark::fastslam
