#include "waymark/fastslam/particles.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/poses.hpp"
#include "waymark/fastslam/resampling.hpp"

namespace waymark::fastslam {
namespace {

using test::matrix_near;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double sum_of_weights(const Particles& p) {
  return std::accumulate(p.weight.data(), p.weight.data() + p.weight.size(), 0.0);
}

double effective(const Particles& p) { return effective_particles({p.weight.data(), p.weight.size()}); }

void set_log_weights(Particles& p, const std::vector<double>& values) {
  std::copy(values.begin(), values.end(), p.log_weight.data());
}

TEST(SemidefiniteRoot, SquaresToTheCovarianceOfAnyRank) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (int rank = 0; rank <= 3; ++rank) {
    Eigen::MatrixXd root(3, rank);
    for (auto& entry : root.reshaped()) entry = random.normal();
    const Eigen::Matrix3d Q = root * root.transpose();
    const Eigen::Matrix3d L = semidefinite_root(Q);
    EXPECT_TRUE(matrix_near(L * L.transpose(), Q, 1e-9)) << "rank " << rank;
  }
  const Eigen::Matrix3d turn_only = Eigen::Vector3d(0.0, 0.0, 4.0).asDiagonal();
  EXPECT_EQ(semidefinite_root(turn_only)(2, 2), 2.0);
}

TEST(Particles, MoveDrawsFromTheMotion) {
  constexpr int kCount = 200'000;
  const Pose2 start{1.0, -2.0, 2.5};
  Particles particles(kCount, start);
  ParticleBlocks blocks(kCount, 2);
  RandomStream random(2, StreamPurpose::kWorld);
  const Motion motion{{0.3, 0.1, 0.9}, test::random_covariance<3>(random, 1e-4)};
  move(particles, motion, {7, StreamPurpose::kMotion, 3}, blocks);

  const PoseEstimate expected = propagate({start, Eigen::Matrix3d::Zero()}, motion);
  const PoseEstimate actual = estimate(particles, blocks);
  // Five standard errors: of a mean sigma / sqrt(N), of a variance sigma^2 sqrt(2 / N).
  const double sigma = std::sqrt(expected.covariance.diagonal().maxCoeff());
  EXPECT_TRUE(matrix_near(difference(actual.T_world_robot, expected.T_world_robot), Eigen::Vector3d::Zero(),
                          5.0 * sigma / std::sqrt(kCount)));
  EXPECT_TRUE(
      matrix_near(actual.covariance, expected.covariance, 5.0 * sigma * sigma * std::sqrt(2.0 / kCount)));
  for (std::size_t i = 0; i < kCount; i += 1000) {
    EXPECT_EQ(particles.cos_theta[i], std::cos(particles.theta_rad[i]));
    EXPECT_LE(std::abs(particles.theta_rad[i]), kPi);
  }
}

TEST(Particles, EstimateIsCircularAndWeighted) {
  Particles particles(3, {0.0, 0.0, kPi - 0.1});
  ParticleBlocks blocks(3);
  particles.theta_rad[1] = -kPi + 0.1;
  particles.x_m[1] = 2.0;
  particles.cos_theta[1] = std::cos(particles.theta_rad[1]);
  particles.sin_theta[1] = std::sin(particles.theta_rad[1]);
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
  EXPECT_NEAR(particles.weight[0], 0.25, 1e-9);
  EXPECT_NEAR(particles.weight[1], 0.75, 1e-9);
  EXPECT_EQ(particles.weight[2], 0.0);
}

TEST(Particles, AParticleWithoutAFiniteWeightDies) {
  Particles particles(4, {});
  ParticleBlocks blocks(4);
  set_log_weights(particles, {kNan, kInfinity, -3.0, -kInfinity});
  ASSERT_TRUE(normalise_weights(particles, blocks));
  EXPECT_EQ(particles.weight[2], 1.0);
  EXPECT_EQ(sum_of_weights(particles), 1.0);
}

TEST(Particles, ASetThatLostAllWeightStartsAgainEvenly) {
  Particles particles(4, {});
  ParticleBlocks blocks(4);
  set_log_weights(particles, {kNan, kInfinity, -kInfinity, -kInfinity});
  EXPECT_FALSE(normalise_weights(particles, blocks));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(particles.weight[i], 0.25);
  EXPECT_TRUE(normalise_weights(particles, blocks));
}

TEST(Particles, TemperingKeepsTheOrderAndTheEffectiveNumber) {
  constexpr int kCount = 1000;
  Particles particles(kCount, {});
  ParticleBlocks blocks(kCount);
  RandomStream random(3, StreamPurpose::kWorld);
  for (const double spread : {10.0, 1e3, 1e9}) {
    for (std::size_t i = 0; i < kCount; ++i) particles.log_weight[i] = spread * random.normal();
    ASSERT_TRUE(normalise_weights(particles, blocks));
    const auto best = std::max_element(particles.weight.data(), particles.weight.data() + kCount);
    temper_weights(particles, 100.0, blocks);
    EXPECT_GE(effective(particles), 100.0 * (1.0 - 1e-9)) << spread;
    EXPECT_LT(effective(particles), 105.0) << spread;
    EXPECT_NEAR(sum_of_weights(particles), 1.0, 1e-12);
    EXPECT_EQ(std::max_element(particles.weight.data(), particles.weight.data() + kCount), best);
  }
}

TEST(Particles, TemperingLeavesAHealthySetAlone) {
  Particles particles(3, {});
  ParticleBlocks blocks(3);
  set_log_weights(particles, {0.0, -1.0, -2.0});
  ASSERT_TRUE(normalise_weights(particles, blocks));
  const double before = particles.weight[2];
  temper_weights(particles, 1.2, blocks);
  EXPECT_EQ(particles.weight[2], before);
}

TEST(Particles, DescendantsAreCopiesAndWeighTheSame) {
  Particles particles(4, {});
  ParticleBlocks blocks(4);
  move(particles, {{1.0, 0.0, 0.0}, Eigen::Matrix3d::Identity()}, {1, StreamPurpose::kMotion, 0}, blocks);
  const Pose2 parent = particles.pose(2);
  const Pose2 untouched = particles.pose(0);
  replace_by_ancestors(particles, std::vector<std::int32_t>{0, 2, 2, 2}, blocks);
  EXPECT_EQ(particles.pose(0), untouched);
  for (const int i : {1, 2, 3}) EXPECT_EQ(particles.pose(i), parent);
  EXPECT_EQ(particles.weight[3], 0.25);
}

}  // namespace
}  // namespace waymark::fastslam
