#include "waymark/ekf/candidate.hpp"

#include <cmath>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/poses.hpp"
#include "waymark/models/pixel_model.hpp"

#include "pixel_world.hpp"

namespace waymark::ekf {
namespace {

using test::matrix_near;
using test::PixelWorld;

/// A corner that was seen from the origin, and its candidate.
struct OneCandidate : PixelWorld {
  explicit OneCandidate(const PixelSlamOptions& options = {}) : PixelWorld(options) {
    candidate.depths = DepthParticles(options.depth);
    const Eigen::Vector3d p_camera = in_camera(corner);
    const Eigen::Matrix2d xy_covariance{{2e-5, 3e-6}, {3e-6, 1e-5}};
    candidate.start(test::corner_id(7), *map.map().add_anchor(), p_camera.head<2>() / p_camera.z(),
                    xy_covariance);
    rho = 1.0 / p_camera.z();
  }
  /// As a pixel would do that knows the inverse depth.
  void learn_depth(double mean, double sigma) {
    candidate.depths.score([=](double at) { return -0.5 * std::pow((at - mean) / sigma, 2); });
    candidate.depths.take();
  }
  [[nodiscard]] CandidatePrediction predicted() const { return {candidate, map.map(), prediction}; }

  Eigen::Vector3d corner{3.0, -0.4, 0.7};
  double rho;
  Candidate candidate{.depths = DepthParticles(DepthPrior())};
};

TEST(Candidate, StartsWithoutMemoryOfTheOneBefore) {
  OneCandidate world;
  const std::size_t all = world.candidate.depths.size();
  world.learn_depth(0.5, 0.05);
  world.candidate.looks = world.candidate.matches = world.candidate.images = 3;
  EXPECT_LT(world.candidate.depths.size(), all);
  world.candidate.start(test::corner_id(8), 2, {0.1, 0.2}, Eigen::Matrix2d::Identity());
  EXPECT_EQ(world.candidate.id, test::corner_id(8));
  EXPECT_FALSE(world.candidate.is_free());
  EXPECT_EQ(world.candidate.ray(0.4), Eigen::Vector3d(0.1, 0.2, 0.4));
  EXPECT_EQ(world.candidate.depths.size(), all);
  EXPECT_EQ(world.candidate.looks + world.candidate.matches + world.candidate.images, 0);
  EXPECT_TRUE(Candidate{.depths = DepthParticles(DepthPrior())}.is_free());
}

TEST(CandidatePrediction, IsWhereTheCornerIsAtItsDepth) {
  OneCandidate world;
  world.move({0.4, 0.1, 0.05});
  const auto at = world.predicted().at(world.rho);
  ASSERT_TRUE(at);
  EXPECT_TRUE(matrix_near(at->pixel, world.pixel(world.corner), 1e-9));
}

TEST(CandidatePrediction, CovarianceIsThatOfRobotAnchorRayJitterAndPatchDrift) {
  OneCandidate world({.landmark_noise_px = 0.3, .jitter_deg = 0.2});
  world.move({0.4, 0.1, 0.05}, 0.02);
  const Camera& camera = world.prediction.camera();
  const auto pixel = [&](const Eigen::Matrix<double, 8, 1>& x) -> Eigen::Vector2d {
    return observe_ray(camera, camera.pose(test::to_pose(x.segment<3>(0))),
                       camera.pose(test::to_pose(x.segment<3>(3))), {x[6], x[7], world.rho})
        ->predicted;
  };
  const PixelMap& map = world.map.map();
  const Pose2 here = map.state().pose().T_world_robot;
  const Pose2 anchor = map.anchor_pose(world.candidate.anchor);
  Eigen::Matrix<double, 8, 1> x;
  x << test::to_vector(here), test::to_vector(anchor), world.candidate.xy;
  Eigen::Matrix<double, 8, 8> P = Eigen::Matrix<double, 8, 8>::Zero();
  const auto element = static_cast<Eigen::Index>(3 + 3 * map.anchor_element(world.candidate.anchor));
  const Eigen::MatrixXd all = map.state().covariance();
  P.block<3, 3>(0, 0) = all.block<3, 3>(0, 0);
  P.block<3, 3>(0, 3) = all.block<3, 3>(0, element);
  P.block<3, 3>(3, 0) = all.block<3, 3>(element, 0);
  P.block<3, 3>(3, 3) = all.block<3, 3>(element, element);
  P.block<2, 2>(6, 6) = world.candidate.xy_covariance;
  const Eigen::Matrix<double, 2, 8> H = test::numeric_jacobian(pixel, x);
  const Eigen::Vector3d p_camera = world.in_camera(world.corner);
  const Eigen::Matrix2d J = world.prediction.noise()
                                .attitude_jitter(p_camera, camera.project(p_camera)->dpixel_dpoint)[0]
                                .J.topRows<2>();
  const double process_noise_px2 = world.prediction.noise().process_noise_px2(
      world.corner, camera.pose(anchor).p_world_camera, camera.pose(here).p_world_camera);
  EXPECT_GT(process_noise_px2, 0.0);
  const Eigen::Matrix2d expected =
      H * P * H.transpose() + J * J.transpose() + process_noise_px2 * Eigen::Matrix2d::Identity();
  EXPECT_TRUE(matrix_near(world.predicted().at(world.rho)->S, expected, 1e-6 * expected.trace()));
}

TEST(CandidatePrediction, ExpectsTheMomentsOfAllThatItsDepthsPredict) {
  OneCandidate world;
  world.move({0.4, 0.1, 0.05});
  world.learn_depth(world.rho, 0.03);
  const CandidatePrediction predicted = world.predicted();
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& [rho, weight] : world.candidate.depths.weighted())
    mean += weight * predicted.at(rho)->pixel;
  Eigen::Matrix2d S = world.prediction.noise().of_search();
  for (const auto& [rho, weight] : world.candidate.depths.weighted()) {
    const auto at = *predicted.at(rho);
    S += weight * (at.S + (at.pixel - mean) * (at.pixel - mean).transpose());
  }
  const auto expected = predicted.expect();
  ASSERT_TRUE(expected);
  EXPECT_EQ(expected->id, test::corner_id(7));
  EXPECT_TRUE(expected->candidate);
  EXPECT_TRUE(matrix_near(expected->predicted_px, mean, 0.02));
  EXPECT_TRUE(matrix_near(expected->S, S, 0.03 * S.trace()));
  EXPECT_TRUE(matrix_near(expected->p_world_m, world.corner, 0.1));
}

TEST(CandidatePrediction, ExpectsNothingBesideTheImage) {
  OneCandidate world;
  EXPECT_TRUE(world.predicted().expect());
  world.move({0.0, 0.0, 0.6});
  EXPECT_FALSE(world.predicted().expect());
  world.move({0.0, 0.0, 2.5});
  EXPECT_FALSE(world.predicted().expect()) << "behind";
}

}  // namespace
}  // namespace waymark::ekf
