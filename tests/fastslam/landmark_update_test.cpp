#include "waymark/fastslam/landmark_update.hpp"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/poses.hpp"
#include "waymark/core/gaussian.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark::fastslam {
namespace {

using test::matrix_near;

constexpr int kCount = 40;

Eigen::Vector2d mean_of(const LandmarkGaussian& m) { return {m.x, m.y}; }
Eigen::Matrix2d covariance_of(const LandmarkGaussian& m) {
  return Eigen::Matrix2d{{m.xx, m.xy}, {m.xy, m.yy}};
}

/// Particles anywhere, of random weights, and one landmark that each of them sees elsewhere.
struct Scene {
  explicit Scene(std::uint64_t seed)
      : random(seed, StreamPurpose::kWorld), particles(kCount, {}), blocks(kCount), store(blocks) {
    move(particles, {{}, Eigen::Vector3d(9.0, 9.0, 4.0).asDiagonal()}, {seed, StreamPurpose::kMotion, 0},
         blocks);
    for (std::size_t i = 0; i < kCount; ++i) particles.log_weight[i] = random.normal();
    (void)normalise_weights(particles, blocks);
    store.add();
    landmark = store.touch(0);
    for (std::size_t i = 0; i < kCount; ++i) {
      const Eigen::Matrix2d Sigma = test::random_covariance<2>(random, 0.1);
      landmark.x[i] = 10.0 + random.normal();
      landmark.y[i] = -7.0 + random.normal();
      landmark.xx[i] = Sigma(0, 0);
      landmark.xy[i] = Sigma(0, 1);
      landmark.yy[i] = Sigma(1, 1);
    }
  }

  InnovationMoments update(const RangeBearing& z, const Eigen::Matrix2d& R) {
    return update_landmark({z, R, mount}, particles, landmark, store.draft(), log_likelihood, 0, kCount);
  }

  RandomStream random;
  Particles particles;
  ParticleBlocks blocks;
  LandmarkStore store;
  LandmarkColumns landmark;
  Pose2 mount{0.4, -0.3, 2.0};
  double log_likelihood[kCount] = {};
};

TEST(UpdateLandmark, EqualsTheTextbookFilterForEachParticle) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Scene scene(seed);
    const RangeBearing z{12.0, scene.random.uniform(-kPi, kPi)};
    const Eigen::Matrix2d R = test::random_covariance<2>(scene.random, 0.02);
    scene.update(z, R);
    for (std::size_t i = 0; i < kCount; ++i) {
      const LandmarkGaussian before = scene.landmark.at(i);
      const auto h = RangeBearingModel::linearize(scene.particles.pose(static_cast<int>(i)), scene.mount,
                                                  mean_of(before));
      const Eigen::Vector2d nu = RangeBearingModel::innovation(z, h.predicted);
      const Eigen::Matrix2d Sigma = covariance_of(before);
      const Eigen::Matrix2d Z = h.H_landmark * Sigma * h.H_landmark.transpose() + R;
      const Eigen::Matrix2d K = Sigma * h.H_landmark.transpose() * Z.inverse();
      const LandmarkGaussian after = scene.store.draft().at(i);
      EXPECT_TRUE(matrix_near(mean_of(after), mean_of(before) + K * nu, 1e-9));
      EXPECT_TRUE(matrix_near(covariance_of(after), Sigma - K * Z * K.transpose(), 1e-11));
      // log N(nu; 0, Z) without its constant.
      EXPECT_NEAR(scene.log_likelihood[i], -0.5 * nu.dot(Z.inverse() * nu) - 0.5 * std::log(Z.determinant()),
                  1e-8);
    }
  }
}

TEST(UpdateLandmark, MomentsAreThoseOfTheMixture) {
  Scene scene(1);
  const RangeBearing z{12.0, 1.0};
  const Eigen::Matrix2d R = test::random_covariance<2>(scene.random, 0.02);
  const auto moments = scene.update(z, R);
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  double log_likelihood = 0.0;
  double first_bearing_rad = 0.0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const LandmarkGaussian m = scene.landmark.at(i);
    const auto h =
        RangeBearingModel::linearize(scene.particles.pose(static_cast<int>(i)), scene.mount, mean_of(m));
    Eigen::Vector2d nu = RangeBearingModel::innovation(z, h.predicted);
    if (i == 0) first_bearing_rad = nu.y();
    nu.y() = first_bearing_rad + wrap_angle(nu.y() - first_bearing_rad);
    const double w = scene.particles.weight[i];
    mean += w * nu;
    second += w * (h.H_landmark * covariance_of(m) * h.H_landmark.transpose() + R + nu * nu.transpose());
    log_likelihood += w * scene.log_likelihood[i];
  }
  EXPECT_TRUE(matrix_near(Eigen::Vector2d(moments[0], moments[1]), mean, 1e-10));
  EXPECT_TRUE(matrix_near(Eigen::Matrix2d{{moments[2], moments[3]}, {moments[3], moments[4]}}, second, 1e-9));
  EXPECT_NEAR(moments[5], log_likelihood, 1e-9);
}

TEST(UpdateLandmark, StaysPositiveDefiniteHoweverSharpTheSensor) {
  Scene scene(2);
  // Ten thousand sightings by a sensor good to a micrometre and a nanoradian.
  const Eigen::Matrix2d R = Eigen::Vector2d(1e-12, 1e-18).asDiagonal();
  for (int sighting = 0; sighting < 10'000; ++sighting) {
    scene.update({12.0 + 1e-6 * scene.random.normal(), 1.0}, R);
    scene.store.accept(0);
    scene.landmark = scene.store.touch(0);
  }
  for (std::size_t i = 0; i < kCount; ++i) {
    const LandmarkGaussian m = scene.landmark.at(i);
    EXPECT_GT(m.xx, 0.0);
    EXPECT_GT(m.yy, 0.0);
    EXPECT_LE(m.xy * m.xy, m.xx * m.yy * (1.0 + 1e-9));
    EXPECT_TRUE(std::isfinite(m.x) && std::isfinite(m.y));
  }
}

TEST(UpdateLandmark, IsFiniteWithALandmarkOnTheSensor) {
  Scene scene(3);
  for (std::size_t i = 0; i < kCount; ++i) {
    const Pose2 T_world_sensor = scene.particles.pose(static_cast<int>(i)) * scene.mount;
    scene.landmark.x[i] = T_world_sensor.x_m;
    scene.landmark.y[i] = T_world_sensor.y_m;
  }
  for (const double moment : scene.update({12.0, 1.0}, Eigen::Matrix2d::Identity()))
    EXPECT_TRUE(std::isfinite(moment));
}

TEST(PlaceLandmark, InvertsTheMeasurementForEachParticle) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Scene scene(seed);
    const RangeBearing z{scene.random.uniform(0.5, 20.0), scene.random.uniform(-kPi, kPi)};
    const Eigen::Matrix2d R = test::random_covariance<2>(scene.random, 0.02);
    place_landmark({z, R, scene.mount}, scene.particles, scene.landmark, 0, kCount);
    for (std::size_t i = 0; i < kCount; ++i) {
      const auto inverse =
          RangeBearingModel::locate(scene.particles.pose(static_cast<int>(i)), scene.mount, z);
      const Eigen::Matrix2d Sigma = inverse.G_measurement * R * inverse.G_measurement.transpose();
      EXPECT_TRUE(matrix_near(mean_of(scene.landmark.at(i)), inverse.p_world, 1e-11));
      EXPECT_TRUE(matrix_near(covariance_of(scene.landmark.at(i)), Sigma, 1e-9 * Sigma.norm()));
    }
  }
}

}  // namespace
}  // namespace waymark::fastslam
