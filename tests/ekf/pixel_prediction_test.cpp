#include "waymark/ekf/pixel_prediction.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "waymark/core/angle.hpp"
#include "waymark/models/pixel_model.hpp"

#include "pixel_world.hpp"

namespace waymark::ekf {
namespace {

using test::matrix_near;
using test::PixelWorld;

const Eigen::Vector3d kAhead(4.0, 0.3, 0.6);

/// Feature 0 is a point, feature 1 a ray, seen from half a metre further on.
struct PointAndRay : PixelWorld {
  explicit PointAndRay(const PixelSlamOptions& options = {}) : PixelWorld(options) {
    load({kAhead});
    add_ray(1, {3.0, -0.4, 0.7}, 0.1);
    move({0.5, 0.1, 0.05});
  }
};

TEST(PixelPrediction, LinearizesAPointAndARayAtThePresentEstimate) {
  const PointAndRay world;
  const PixelMap& map = world.map.map();
  const Camera& camera = world.prediction.camera();
  const FoundPixel point{0, {150.0, 100.0}, 0.1 * Eigen::Matrix2d::Identity()};
  const auto of_point = world.prediction.linearize(map, point, world.here());
  const auto h = observe_point(camera, world.here(), map.state().landmark(map.feature(0).element));
  ASSERT_TRUE(of_point && h);
  EXPECT_EQ(of_point->landmark, map.feature(0).element);
  EXPECT_EQ(of_point->anchor, -1);
  EXPECT_EQ(of_point->nu, point.z_px - h->predicted);  // the jitter of a new image is expected to be 0
  EXPECT_EQ(of_point->H_pose, h->H_pose);
  EXPECT_EQ(of_point->H_landmark, h->H_landmark);
  EXPECT_EQ(of_point->R, point.R);
  EXPECT_EQ(of_point->errors[0].pair, 0);

  const FoundPixel ray{1, {160.0, 110.0}, 0.2 * Eigen::Matrix2d::Identity()};
  const auto of_ray = world.prediction.linearize(map, ray, world.here());
  const auto g = observe_ray(camera, world.here(), camera.pose(map.anchor_pose(map.feature(1).anchor)),
                             map.state().landmark(map.feature(1).element));
  ASSERT_TRUE(of_ray && g);
  EXPECT_EQ(of_ray->anchor, map.anchor_element(map.feature(1).anchor));
  EXPECT_EQ(of_ray->nu, ray.z_px - g->predicted);
  EXPECT_EQ(of_ray->H_landmark, g->H_ray);
  EXPECT_EQ(of_ray->H_anchor, g->H_anchor);
}

TEST(PixelPrediction, AtTheProposalItIsWhatItWillBeThere) {
  PointAndRay world({.consistency = Consistency::kStandard});
  PixelMap& map = world.map.map();
  FoundPixel found = world.find(0, kAhead);
  found.z_px += Eigen::Vector2d(2.0, -1.0);
  const auto linearization = world.prediction.linearize(map, found, world.here());
  ASSERT_TRUE(linearization);
  ASSERT_TRUE(map.state().propose({&*linearization, 1}));
  for (const int feature : {0, 1}) {
    const FoundPixel other{feature, {150.0, 100.0}, Eigen::Matrix2d::Identity()};
    const auto proposed = world.prediction.linearize_at_proposal(map, other);
    PointAndRay after({.consistency = Consistency::kStandard});
    ASSERT_TRUE(after.map.map().state().update({&*linearization, 1}));
    const auto reached = after.prediction.linearize(after.map.map(), other, after.here());
    ASSERT_TRUE(proposed && reached);
    EXPECT_TRUE(matrix_near(proposed->nu, reached->nu, 1e-9));
    EXPECT_TRUE(matrix_near(proposed->H_pose, reached->H_pose, 1e-9));
    EXPECT_TRUE(matrix_near(proposed->H_landmark, reached->H_landmark, 1e-9));
  }
}

TEST(PixelPrediction, FirstEstimatesGiveTheJacobiansButNotTheInnovation) {
  PointAndRay world({.consistency = Consistency::kFej});
  PixelMap& map = world.map.map();
  FoundPixel found = world.find(0, kAhead);
  found.z_px += Eigen::Vector2d(2.0, -1.0);
  const auto before = world.prediction.linearize(map, found, world.here());
  ASSERT_TRUE(before);
  ASSERT_TRUE(map.state().update({&*before, 1}));
  const auto after = world.prediction.linearize(map, found, world.here());
  ASSERT_TRUE(after);
  EXPECT_EQ(after->H_pose, before->H_pose);
  EXPECT_EQ(after->H_landmark, before->H_landmark);
  EXPECT_LT(after->nu.norm(), 0.5 * before->nu.norm());
}

TEST(PixelPrediction, ExpectsWithTheCovarianceOfTheInnovation) {
  PointAndRay world({.landmark_noise_px = 0.0});
  PixelMap& map = world.map.map();
  for (const int feature : {0, 1}) {
    const auto expected = world.prediction.expect(map, feature, world.here());
    ASSERT_TRUE(expected);
    EXPECT_EQ(expected->id, test::corner_id(feature));
    EXPECT_FALSE(expected->candidate);
    const Eigen::Matrix2d& R = world.prediction.noise().of_search();
    const auto linearization =
        world.prediction.linearize(map, {feature, expected->predicted_px, R}, world.here());
    ASSERT_TRUE(linearization);
    EXPECT_LT(linearization->nu.norm(), 1e-9);
    EXPECT_EQ(expected->S, map.state().innovation_covariance(*linearization));
    EXPECT_NEAR(expected->information_nats, 0.5 * std::log(expected->S.determinant() / R.determinant()),
                1e-12);
    EXPECT_TRUE(matrix_near(expected->p_world_m, world.prediction.place(map, feature), 1e-12));
  }
}

TEST(PixelPrediction, ExpectsNothingWhosePatchIsNotWhollyInTheImage) {
  EXPECT_TRUE(PixelWorld().prediction.is_in_image({8.5, 8.5}));
  EXPECT_FALSE(PixelWorld().prediction.is_in_image({100.0, 7.0}));
  EXPECT_FALSE(PixelWorld().prediction.is_in_image({313.0, 100.0}));
  PixelWorld world;
  world.load({kAhead, {4.0, 2.17, 0.6}, {-4.0, 0.0, 0.6}});  // in the middle, at the rim, behind
  EXPECT_TRUE(world.prediction.expect(world.map.map(), 0, world.here()));
  EXPECT_FALSE(world.prediction.expect(world.map.map(), 1, world.here()));
  EXPECT_FALSE(world.prediction.expect(world.map.map(), 2, world.here()));
}

TEST(PixelPrediction, ExpectsAPointOnlyFromWhereItIsRecognised) {
  PixelWorld world;
  world.load({kAhead});
  PixelMap& map = world.map.map();
  const Eigen::Vector3d view_m = world.here().p_world_camera - kAhead;
  const auto first_seen = [&](double turn_deg, double ratio) {
    map.feature(0).first_view_m =
        Eigen::AngleAxisd(to_radians(turn_deg), Eigen::Vector3d::UnitZ()) * view_m / ratio;
    return world.prediction.expect(map, 0, world.here()).has_value();
  };
  EXPECT_TRUE(first_seen(40.0, 1.0));
  EXPECT_FALSE(first_seen(50.0, 1.0));
  EXPECT_TRUE(first_seen(0.0, 0.45));
  EXPECT_FALSE(first_seen(0.0, 0.35));
  EXPECT_TRUE(first_seen(0.0, 2.4));
  EXPECT_FALSE(first_seen(0.0, 2.6));
}

TEST(PixelPrediction, ARayThatLeadsBehindInfinityIsAsFarAwayAsPointsMayBe) {
  PixelWorld world({.depth = {.farthest_m = 20.0}});
  const int anchor = *world.map.map().add_anchor();
  const int feature =
      world.map.add_ray(test::corner_id(1), anchor, {0.0, 0.0, -0.1}, 1e-3 * Eigen::Matrix3d::Identity(), 1);
  EXPECT_TRUE(
      matrix_near(world.prediction.place(world.map.map(), feature), Eigen::Vector3d(20.1, 0.0, 0.5), 1e-9));
}

TEST(PixelPrediction, APointWandersAcrossTheLineOfSightAsTheViewTurns) {
  PixelWorld world({.landmark_noise_px = 0.5});
  world.load({kAhead}, 0.001);
  PixelMap& map = world.map.map();
  const auto covariance = [&] { return map.state().landmark_covariance(map.feature(0).element); };
  const Eigen::Vector3d seen_from = world.here().p_world_camera;
  world.move({0.3, 0.5, 0.0});
  const CameraPose here = world.here();
  const Eigen::Matrix3d before = covariance();
  world.prediction.add_process_noise(map, 0, kAhead, here);
  const Eigen::Matrix3d added = covariance() - before;
  const Eigen::Vector3d view = kAhead - here.p_world_camera;
  const double sigma_m =
      std::sqrt(world.prediction.noise().process_noise_px2(kAhead, seen_from, here.p_world_camera)) *
      view.norm() / world.prediction.camera().options().fu_px;
  EXPECT_NEAR(added.trace(), 2.0 * sigma_m * sigma_m, 1e-9 * added.trace());
  EXPECT_LT((added * view.normalized()).norm(), 1e-9 * added.trace());
  const Eigen::Matrix3d once = covariance();
  world.prediction.add_process_noise(map, 0, kAhead, here);
  EXPECT_TRUE(matrix_near(covariance(), once, 1e-15)) << "from the same place";
}

TEST(PixelPrediction, ARayThatIsExpectedWandersInItsDirectionAlone) {
  PixelWorld world({.landmark_noise_px = 0.5});
  const int ray = world.add_ray(1, kAhead, 0.1);
  PixelMap& map = world.map.map();
  const auto covariance = [&] { return map.state().landmark_covariance(map.feature(ray).element); };
  const Eigen::Matrix3d before = covariance();
  world.move({0.3, 0.5, 0.0});
  ASSERT_TRUE(world.prediction.expect(map, ray, world.here()));
  const Eigen::Matrix3d added = covariance() - before;
  EXPECT_GT(added(0, 0), 0.0);
  EXPECT_EQ(added(0, 0), added(1, 1));
  EXPECT_EQ(added.row(2).norm(), 0.0);
}

}  // namespace
}  // namespace waymark::ekf
