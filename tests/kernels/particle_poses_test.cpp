#include "waymark/kernels/particle_poses.hpp"

#include <cmath>
#include <set>

#include <Eigen/Cholesky>

#include "support/matrix_near.hpp"
#include "support/poses.hpp"
#include "waymark/core/angle.hpp"

#include "kernels/kernel_support.hpp"
#include "kernels/particle_support.hpp"

namespace waymark::kernels {
namespace {

using test::Columns;
using test::matrix_near;

constexpr std::size_t kParticles = 37;
constexpr Increment kExpected{0.3F, -0.1F, 0.4F};

/// World poses far from the origin.
struct World {
  explicit World(std::size_t count) : x(round_up_particles(count)), y(x.size()), theta(x.size()) {
    RandomStream random(3, StreamPurpose::kWorld);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = 1e6 + random.normal();
      y[i] = -2e6 + random.normal();
      theta[i] = random.uniform(-kPi, kPi);
    }
  }
  [[nodiscard]] WorldPoses read() const { return {x.data(), y.data(), theta.data()}; }
  [[nodiscard]] MovingPoses move() { return {x.data(), y.data(), theta.data()}; }
  [[nodiscard]] Pose2 pose(std::size_t i) const { return {x[i], y[i], theta[i]}; }
  AlignedArray<double> x, y, theta;
};

class ParticlePoses : public test::OnEveryInstructionSet {};

WAYMARK_ON_EVERY_INSTRUCTION_SET(ParticlePoses);

TEST_P(ParticlePoses, AreLoadedToTheLastDigitOfAFloatFarFromTheOrigin) {
  const World world(kParticles);
  Columns columns(kParticles);
  const PoseColumns fast = columns.add_poses();
  const PoseColumns plain = columns.add_poses();
  load_poses(world.read(), 1e6, -2e6, fast, kParticles);
  reference::load_poses(world.read(), 1e6, -2e6, plain, kParticles);
  for (std::size_t i = 0; i < kParticles; ++i) {
    EXPECT_EQ(fast.x[i], plain.x[i]);
    EXPECT_EQ(fast.y[i], static_cast<float>(world.y[i] + 2e6));
    EXPECT_NEAR(fast.cos[i], std::cos(world.theta[i]), 3e-7);
    EXPECT_NEAR(fast.sin[i], std::sin(world.theta[i]), 3e-7);
    EXPECT_NEAR(plain.sin[i], std::sin(world.theta[i]), 3e-7);
  }
}

TEST_P(ParticlePoses, SensorsStandWhereTheyAreMounted) {
  const World world(kParticles);
  Columns columns(kParticles);
  const PoseColumns robots = columns.add_poses();
  const PoseColumns sensors = columns.add_poses();
  load_poses(world.read(), 1e6, -2e6, robots, kParticles);
  place_sensors(robots, {0.4F, -0.3F, 0.8F, 0.6F}, sensors, kParticles);
  for (std::size_t i = 0; i < kParticles; ++i) {
    const Pose2 expected = Pose2{robots.x[i], robots.y[i], world.theta[i]} * Pose2{0.4, -0.3, 0.0};
    EXPECT_NEAR(sensors.x[i], expected.x_m, 1e-6);
    EXPECT_NEAR(sensors.y[i], expected.y_m, 1e-6);
    EXPECT_EQ(sensors.cos[i], robots.cos[i]);
  }
}

/// The words of the scalar generator of core/random.hpp, by the formula of Box and Muller.
std::array<double, 3> plain_normals(const DrawKey& key, std::uint32_t particle) {
  const auto w =
      philox4x32({0, (key.purpose << 24) ^ static_cast<std::uint32_t>(key.step >> 32),
                  static_cast<std::uint32_t>(key.step), particle},
                 {static_cast<std::uint32_t>(key.seed), static_cast<std::uint32_t>(key.seed >> 32)});
  const auto radius = [](std::uint32_t word) {
    return std::sqrt(-2.0 * std::log(((word >> 1) + 0.5) * 0x1p-31));
  };
  const auto angle = [](std::uint32_t word) { return static_cast<std::int32_t>(word) * kPi * 0x1p-31; };
  return {radius(w[0]) * std::cos(angle(w[1])), radius(w[0]) * std::sin(angle(w[1])),
          radius(w[2]) * std::cos(angle(w[3]))};
}

TEST_P(ParticlePoses, NormalsAreThoseOfTheScalarGenerator) {
  const DrawKey key{0x123456789ABCDEF0U, 1, 0x100000007U, 256};
  Columns columns(kParticles);
  float* const n[]{columns.add(), columns.add(), columns.add()};
  draw_normals(key, n[0], n[1], n[2], kParticles);
  for (std::size_t i = 0; i < kParticles; ++i) {
    const auto expected = plain_normals(key, static_cast<std::uint32_t>(256 + i));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(n[k][i], expected[k], 2e-6) << i;
  }
}

TEST_P(ParticlePoses, DrawAsTheScalarFormulaDoes) {
  test::ParticleScene scene(kParticles, LandmarkForm::kPoint, ObservationKind::kRange, 1, 1);
  float* const n[]{scene.columns().add(), scene.columns().add(), scene.columns().add()};
  draw_normals({5}, n[0], n[1], n[2], kParticles);
  World fast(kParticles);
  World plain(kParticles);
  const PoseColumns robots = scene.columns().add_poses();
  const PoseColumns plain_robots = scene.columns().add_poses();
  load_poses(fast.read(), 1e6, -2e6, robots, kParticles);
  load_poses(plain.read(), 1e6, -2e6, plain_robots, kParticles);
  draw_poses(scene.increments, kExpected, n[0], n[1], n[2], robots, fast.move(), kParticles);
  reference::draw_poses(scene.increments, kExpected, n[0], n[1], n[2], plain_robots, plain.move(),
                        kParticles);
  for (std::size_t i = 0; i < kParticles; ++i) {
    EXPECT_TRUE(matrix_near(difference(fast.pose(i), plain.pose(i)), Eigen::Vector3d::Zero(), 1e-6));
    EXPECT_NEAR(robots.x[i], fast.x[i] - 1e6, 2e-6);
    EXPECT_NEAR(robots.cos[i], std::cos(fast.theta[i]), 1e-6);
    EXPECT_LE(std::abs(fast.theta[i]), kPi + 1e-12);
  }
}

TEST(DrawNormals, HaveTheMomentsOfTheNormalDistribution) {
  constexpr std::size_t kMany = 1'000'000;
  Columns columns(kMany);
  float* const n[]{columns.add(), columns.add(), columns.add()};
  draw_normals({11}, n[0], n[1], n[2], kMany);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  double fourth = 0.0;
  for (std::size_t i = 0; i < kMany; ++i) {
    const Eigen::Vector3d x(n[0][i], n[1][i], n[2][i]);
    mean += x / kMany;
    second += x * x.transpose() / kMany;
    fourth += x.array().pow(4).sum() / (3.0 * kMany);
  }
  // Five standard errors.
  EXPECT_TRUE(matrix_near(mean, Eigen::Vector3d::Zero(), 5e-3));
  EXPECT_TRUE(matrix_near(second, Eigen::Matrix3d::Identity(), 5.0 * std::sqrt(2.0) * 1e-3));
  EXPECT_NEAR(fourth, 3.0, 5.0 * std::sqrt(96.0 / 3.0) * 1e-3);
}

TEST(DrawNormals, BlocksMakeTheSameNumbersAsTheWhole) {
  Columns columns(512);
  float* const whole[]{columns.add(), columns.add(), columns.add()};
  float* const part[]{columns.add(), columns.add(), columns.add()};
  draw_normals({1, 2, 3, 0}, whole[0], whole[1], whole[2], 512);
  draw_normals({1, 2, 3, 256}, part[0], part[1], part[2], 256);
  for (std::size_t i = 0; i < 256; ++i) EXPECT_EQ(whole[1][256 + i], part[1][i]);
}

/// With unit normals as input, one at a time, a draw shows the columns of a root of the covariance.
Eigen::Matrix3d root_of(const Eigen::Matrix3d& P) {
  Columns columns(16);
  const IncrementColumns increments = columns.add_increments();
  const Eigen::Matrix3f Q = P.cast<float>();
  fill_increments({0.0F, 0.0F, 0.0F, Q(0, 0), Q(0, 1), Q(0, 2), Q(1, 1), Q(1, 2), Q(2, 2)}, increments, 16);
  const PoseColumns robots = columns.add_poses();
  float* const n[]{columns.add(), columns.add(), columns.add()};
  AlignedArray<double> x(16), y(16), theta(16);
  for (std::size_t i = 0; i < 16; ++i) {
    robots.cos[i] = 1.0F;
    for (std::size_t k = 0; k < 3; ++k) n[k][i] = i == k ? 1.0F : 0.0F;
  }
  draw_poses(increments, {}, n[0], n[1], n[2], robots, {x.data(), y.data(), theta.data()}, 16);
  return Eigen::Matrix3d{{x[0], x[1], x[2]}, {y[0], y[1], y[2]}, {theta[0], theta[1], theta[2]}};
}

TEST(DrawPoses, ByARootOfTheCovarianceOfAnyRank) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (int rank = 0; rank <= 3; ++rank) {
    Eigen::MatrixXd factor(3, rank);
    for (auto& entry : factor.reshaped()) entry = 0.3 * random.normal();
    const Eigen::Matrix3d P = factor * factor.transpose();
    const Eigen::Matrix3d L = root_of(P);
    EXPECT_TRUE(matrix_near(L * L.transpose(), P, 2e-4 * (P.norm() + 1e-9))) << "rank " << rank;
  }
  const Eigen::Matrix3d turn_only = Eigen::Vector3d(0.0, 0.0, 0.04).asDiagonal();
  EXPECT_NEAR(root_of(turn_only)(2, 2), 0.2, 1e-7);
}

TEST(DrawPoses, AHeadingThatWasWrongFromTheStartSwingsTheEnd) {
  Columns columns(16);
  const IncrementColumns increments = columns.add_increments();
  fill_increments({0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.25F}, increments, 16);
  const PoseColumns robots = columns.add_poses();
  for (std::size_t i = 0; i < 16; ++i) robots.cos[i] = 1.0F;
  float* const n[]{columns.add(), columns.add(), columns.add()};
  n[2][5] = 1.5F;
  World world(16);
  const Pose2 start = world.pose(5);
  load_poses(world.read(), 1e6, -2e6, robots, 16);
  draw_poses(increments, {10.0F, 0.0F, 0.2F}, n[0], n[1], n[2], robots, world.move(), 16);
  const Pose2 expected = start * Pose2{0.0, 0.0, 0.75} * Pose2{10.0, 0.0, 0.2};
  EXPECT_TRUE(matrix_near(difference(world.pose(5), expected), Eigen::Vector3d::Zero(), 1e-5));
}

TEST(DrawPoses, ARobotThatStandsStillIsNotMovedByABit) {
  World world(kParticles);
  const World before(kParticles);
  Columns columns(kParticles);
  const IncrementColumns increments = columns.add_increments();
  fill_increments({}, increments, kParticles);
  const PoseColumns robots = columns.add_poses();
  load_poses(world.read(), 1e6, -2e6, robots, kParticles);
  float* const n[]{columns.add(), columns.add(), columns.add()};
  draw_normals({5}, n[0], n[1], n[2], kParticles);
  draw_poses(increments, {}, n[0], n[1], n[2], robots, world.move(), kParticles);
  for (std::size_t i = 0; i < kParticles; ++i) EXPECT_EQ(world.pose(i), before.pose(i));
}

}  // namespace
}  // namespace waymark::kernels
