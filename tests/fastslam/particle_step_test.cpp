#include "waymark/fastslam/particle_step.hpp"

#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/poses.hpp"
#include "waymark/fastslam/landmark_store.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark::fastslam {
namespace {

using kernels::LandmarkForm;
using kernels::ObservationKind;
using test::matrix_near;

constexpr StreamKey kKey{9, StreamPurpose::kMotion, 4};
const Pose2 kStart{0.1, 0.2, 0.3};
const Pose2 kMount{0.1, -0.05, 0.2};

/// Particles at one place that all know the same point.
struct Scene {
  explicit Scene(int particles, int threads = 1)
      : blocks(particles, threads), set(particles, kStart), store(blocks) {
    store.add(LandmarkForm::kPoint, {0.0, 0.0});
    const auto view = store.view(0, {0.0, 0.0});
    const auto& m = view.modes->gaussian;
    for (int i = 0; i < particles; ++i) {
      m.a[i] = 3.0F;
      m.b[i] = 0.5F;
      m.aa[i] = 0.02F;
      m.ab[i] = 0.005F;
      m.bb[i] = 0.01F;
    }
  }

  [[nodiscard]] AcceptedObservation observation(bool shapes_motion) const {
    const double direction = z.bearing_rad + kMount.theta_rad;
    const kernels::SensorMount mount{0.1F, -0.05F, static_cast<float>(std::cos(kMount.theta_rad)),
                                     static_cast<float>(std::sin(kMount.theta_rad))};
    return {{{ObservationKind::kRangeBearing, static_cast<float>(z.range_m),
              static_cast<float>(std::cos(direction)), static_cast<float>(std::sin(direction)),
              static_cast<float>(R(0, 0)), static_cast<float>(R(0, 1)), static_cast<float>(R(1, 1))},
             mount,
             store.view(0, {0.0, 0.0})},
            1.0,
            shapes_motion};
  }

  /// Innovation and its covariance without the robot's part, at a pose.
  struct Look {
    Eigen::Vector2d nu;
    Eigen::Matrix2d Z;
    Eigen::Matrix<double, 2, 3> Hx;
  };
  [[nodiscard]] Look look(const Pose2& pose) const {
    const auto [predicted, Hx, Hm] = RangeBearingModel::linearize(pose, kMount, {3.0, 0.5});
    const Eigen::Matrix2d Sigma{{0.02, 0.005}, {0.005, 0.01}};
    return {RangeBearingModel::innovation(z, predicted), Hm * Sigma * Hm.transpose() + R, Hx};
  }

  RangeBearing z{2.7, -0.35};
  Eigen::Matrix2d R{{1e-3, 2e-4}, {2e-4, 5e-4}};
  ParticleBlocks blocks;
  Particles set;
  LandmarkStore store;
};

double log_normal(const Eigen::Vector2d& nu, const Eigen::Matrix2d& S) {
  return -0.5 * (nu.dot(S.inverse() * nu) + std::log(S.determinant()));
}

/// Five standard errors: of a mean sigma / sqrt(N), of a variance sigma^2 sqrt(2 / N).
void expect_drawn_from(const Particles& set, ParticleBlocks& blocks, const Eigen::Vector3d& mean,
                       const Eigen::Matrix3d& P) {
  const PoseEstimate drawn = estimate(set, blocks);  // with the weights that were equal before the step
  const double n = set.count();
  const double variance = P.diagonal().maxCoeff();
  EXPECT_TRUE(matrix_near(test::to_vector(drawn.T_world_robot), mean, 5.0 * std::sqrt(variance / n)));
  EXPECT_TRUE(matrix_near(drawn.covariance, P, 5.0 * std::sqrt(2.0 / n) * variance));
}

TEST(Step, WithoutAnObservationDrawsFromTheMotion) {
  constexpr int kCount = 200'000;
  RandomStream random(2, StreamPurpose::kWorld);
  Scene scene(kCount, 2);
  const Motion motion{{0.3, 0.1, 0.9}, test::random_covariance<3>(random, 1e-4)};
  step(scene.set, motion, {0.0, 0.0}, {}, kKey, scene.blocks);
  const PoseEstimate expected = propagate({kStart, Eigen::Matrix3d::Zero()}, motion);
  expect_drawn_from(scene.set, scene.blocks, test::to_vector(expected.T_world_robot), expected.covariance);
}

TEST(Step, AMotionWithoutSpreadGoesExactlyThere) {
  Scene scene(5);
  const Motion exact{{0.5, 0.1, 0.2}, Eigen::Matrix3d::Zero()};
  step(scene.set, exact, {0.0, 0.0}, {}, kKey, scene.blocks);
  for (int i = 0; i < 5; ++i)
    EXPECT_TRUE(
        matrix_near(difference(scene.set.pose(i), kStart * exact.increment), Eigen::Vector3d::Zero(), 1e-7));
}

/// P = (Hx^T Z^-1 Hx + P0^-1)^-1, mu = mu0 + P Hx^T Z^-1 nu.
TEST(Step, AnObservationThatShapesTheMotionGivesTheInformationForm) {
  constexpr int kCount = 100'000;
  RandomStream random(6, StreamPurpose::kWorld);
  Scene scene(kCount);
  const Motion motion{{0.15, 0.0, 0.02}, test::random_covariance<3>(random, 1e-3)};
  const auto observation = scene.observation(true);
  step(scene.set, motion, {0.0, 0.0}, {&observation, 1}, kKey, scene.blocks);

  const PoseEstimate prior = propagate({kStart, Eigen::Matrix3d::Zero()}, motion);
  const auto [nu, Z, Hx] = scene.look(prior.T_world_robot);
  const Eigen::Matrix3d P = (Hx.transpose() * Z.inverse() * Hx + prior.covariance.inverse()).inverse();
  const Eigen::Vector3d mean = test::to_vector(prior.T_world_robot) + P * Hx.transpose() * Z.inverse() * nu;
  expect_drawn_from(scene.set, scene.blocks, mean, P);
  const double expected = log_normal(nu, Hx * prior.covariance * Hx.transpose() + Z);
  for (int i = 0; i < 100; ++i)
    EXPECT_NEAR(scene.set.log_weights()[static_cast<std::size_t>(i)], expected, 1e-4 * std::abs(expected));
}

TEST(Step, OtherObservationsWeighParticlesWhereTheyWent) {
  Scene scene(50);
  const Motion motion{{0.15, 0.0, 0.02}, 1e-3 * Eigen::Matrix3d::Identity()};
  const auto observation = scene.observation(false);
  step(scene.set, motion, {0.0, 0.0}, {&observation, 1}, kKey, scene.blocks);
  for (int i = 0; i < 50; ++i) {
    const auto look = scene.look(scene.set.pose(i));
    const double expected = log_normal(look.nu, look.Z);
    EXPECT_NEAR(scene.set.log_weights()[static_cast<std::size_t>(i)], expected,
                1e-4 * (1.0 + std::abs(expected)));
  }
}

TEST(Step, ARobotThatStandsStillIsNotMovedAndWeighsTheSameEitherWay) {
  for (const bool shapes : {false, true}) {
    Scene scene(50);
    const auto observation = scene.observation(shapes);
    step(scene.set, {}, {0.0, 0.0}, {&observation, 1}, kKey, scene.blocks);
    const auto look = scene.look(kStart);
    const double expected = log_normal(look.nu, look.Z);
    for (int i = 0; i < 50; ++i) {
      EXPECT_EQ(scene.set.pose(i), kStart);
      EXPECT_NEAR(scene.set.log_weights()[static_cast<std::size_t>(i)], expected, 1e-4 * std::abs(expected));
    }
  }
}

TEST(Step, HalfTheExponentIsHalfTheLogWeight) {
  Scene whole(10);
  Scene half(10);
  const auto observation = whole.observation(true);
  auto weak = half.observation(true);
  weak.exponent = 0.5;
  step(whole.set, {}, {0.0, 0.0}, {&observation, 1}, kKey, whole.blocks);
  step(half.set, {}, {0.0, 0.0}, {&weak, 1}, kKey, half.blocks);
  EXPECT_DOUBLE_EQ(half.set.log_weights()[3], 0.5 * whole.set.log_weights()[3]);
}

TEST(Step, AnObservationIsForThoseThatTakeItAlone) {
  constexpr int kCount = 300;
  std::vector<float> takers(kCount);
  for (int i = 0; i < kCount; i += 3) takers[static_cast<std::size_t>(i)] = 1.0F;
  const Motion motion{{0.3, 0.1, 0.2}, Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal()};
  for (const bool shapes : {false, true}) {
    Scene nobody(kCount);
    Scene all(kCount);
    Scene some(kCount);
    std::vector observations{some.observation(shapes)};
    observations[0].takers = takers.data();
    step(nobody.set, motion, {0.0, 0.0}, {}, kKey, nobody.blocks);
    step(all.set, motion, {0.0, 0.0}, std::vector{all.observation(shapes)}, kKey, all.blocks);
    step(some.set, motion, {0.0, 0.0}, observations, kKey, some.blocks);
    for (int i = 0; i < kCount; ++i) {
      Scene& same = takers[static_cast<std::size_t>(i)] != 0.0F ? all : nobody;
      EXPECT_EQ(some.set.pose(i), same.set.pose(i)) << i;
      EXPECT_EQ(some.set.log_weights()[static_cast<std::size_t>(i)],
                same.set.log_weights()[static_cast<std::size_t>(i)]);
      EXPECT_EQ(some.store.at(0, i).mean, same.store.at(0, i).mean);
      EXPECT_EQ(some.store.at(0, i).covariance, same.store.at(0, i).covariance);
    }
  }
}

TEST(Step, SameBitsOnAnyNumberOfThreads) {
  Scene one(5000, 1);
  Scene three(5000, 3);
  const Motion motion{{0.15, 0.0, 0.02}, 1e-3 * Eigen::Matrix3d::Identity()};
  for (Scene* scene : {&one, &three}) {
    const auto observation = scene->observation(true);
    step(scene->set, motion, {0.0, 0.0}, {&observation, 1}, kKey, scene->blocks);
  }
  for (int i = 0; i < 5000; ++i) {
    EXPECT_EQ(one.set.pose(i), three.set.pose(i));
    EXPECT_EQ(one.store.at(0, i).mean, three.store.at(0, i).mean);
  }
}

TEST(LoadSensors, StandWhereTheyAreMounted) {
  Particles particles(3, {1e6, -1e6, 1.0});
  BlockScratch scratch;
  const auto sensors = load_sensors(particles, {0.1F, -0.05F}, {1e6 - 1.0, -1e6}, {0, 3}, scratch);
  const Pose2 expected = Pose2{1.0, 0.0, 1.0} * Pose2{0.1, -0.05, 0.0};
  EXPECT_NEAR(sensors.x[2], expected.x_m, 1e-6);
  EXPECT_NEAR(sensors.y[2], expected.y_m, 1e-6);
}

}  // namespace
}  // namespace waymark::fastslam
