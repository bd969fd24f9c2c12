#include "waymark/models/pixel_model.hpp"

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/poses.hpp"

#include "random_camera.hpp"

namespace waymark {
namespace {

using test::matrix_near;
using test::numeric_jacobian;
using test::random_camera;
using test::random_pixel;
using test::random_pose;
using test::to_pose;
using test::to_vector;

constexpr double kJacobianTolerance = 1e-3;  // entries of some hundred to some thousand

/// A camera on a robot somewhere, and a point some metres away in its picture.
struct Scene {
  explicit Scene(RandomStream& random)
      : camera(random_camera(random)), T_world_robot(random_pose(random)), pose(camera.pose(T_world_robot)) {
    pixel = random_pixel(camera, random);
    const double depth_m = random.uniform(0.5, 10.0);
    p_world = pose.p_world_camera +
              pose.R_camera_world.transpose() * (depth_m * camera.ray(pixel)->xy.homogeneous());
  }

  Camera camera;
  Pose2 T_world_robot;
  CameraPose pose;
  Eigen::Vector2d pixel;
  Eigen::Vector3d p_world;
};

TEST(PointObservation, IsThePixelOnWhoseRayThePointLies) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 200; ++i) {
    const Scene s(random);
    const auto h = observe_point(s.camera, s.pose, s.p_world);
    ASSERT_TRUE(h);
    EXPECT_TRUE(matrix_near(h->predicted, s.pixel, 1e-8));
    EXPECT_GT(h->p_camera.z(), 0.4);
  }
}

TEST(PointObservation, IsTheArticlesFormulaForALevelCamera) {
  // Vincke et al. 2012, equations 8 and 9; their (x, z, y down) are our (x, y, -z).
  CameraOptions o;
  o.mount = {.x_m = 0.2, .y_m = 0.0, .z_m = 0.4};
  const Camera camera(o);
  const double th = 0.3, dx = 3.0, dy = 1.2;
  const double X = std::sin(th) * dx - std::cos(th) * dy, Z = std::cos(th) * dx + std::sin(th) * dy - 0.2;
  const auto h = observe_point(camera, camera.pose({5.0, -1.0, th}), {5.0 + dx, -1.0 + dy, 0.9});
  ASSERT_TRUE(h);
  EXPECT_NEAR(h->predicted.x(), 159.5 + 277.0 * X / Z, 1e-9);
  EXPECT_NEAR(h->predicted.y(), 119.5 + 277.0 * (0.4 - 0.9) / Z, 1e-9);
}

TEST(PointObservation, JacobiansAgreeWithCentralDifferences) {
  RandomStream random(2, StreamPurpose::kWorld);
  for (int i = 0; i < 300; ++i) {
    const Scene s(random);
    const auto h = observe_point(s.camera, s.pose, s.p_world);
    ASSERT_TRUE(h);
    const auto by_pose = [&](const Eigen::Vector3d& x) {
      return observe_point(s.camera, s.camera.pose(to_pose(x)), s.p_world)->predicted;
    };
    const auto by_point = [&](const Eigen::Vector3d& p) {
      return observe_point(s.camera, s.pose, p)->predicted;
    };
    EXPECT_TRUE(
        matrix_near(h->H_pose, numeric_jacobian(by_pose, to_vector(s.T_world_robot)), kJacobianTolerance));
    EXPECT_TRUE(matrix_near(h->H_landmark, numeric_jacobian(by_point, s.p_world), kJacobianTolerance));
  }
}

TEST(PointObservation, IsNothingBehindOrInTheCamera) {
  const Camera camera;
  const auto pose = camera.pose({});
  EXPECT_FALSE(observe_point(camera, pose, {-1.0, 0.0, 0.3}));
  EXPECT_FALSE(observe_point(camera, pose, {0.5 * kMinDepth_m, 0.0, 0.3}));
}

/// The point of a scene, seen first from where the robot is, and another pose from which it is in front too.
struct TwoViews {
  explicit TwoViews(RandomStream& random) : s(random) {
    const auto made =
        locate_inverse_depth(s.camera, s.pose, s.pixel, 1.0 / (s.p_world - s.pose.p_world_camera).norm());
    point = made->point;
    x_second = to_vector(s.T_world_robot);
    for (auto& x : x_second) x += random.uniform(-0.1, 0.1);
  }

  Scene s;
  InverseDepthPoint point;
  Eigen::Vector3d x_second;
};

TEST(InverseDepth, LiesOnTheRayAtItsDistance) {
  RandomStream random(3, StreamPurpose::kWorld);
  for (int i = 0; i < 200; ++i) {
    const TwoViews v(random);
    EXPECT_TRUE(matrix_near(v.point.p_world(), v.s.p_world, 1e-9));
    EXPECT_NEAR(v.point.direction().norm(), 1.0, 1e-12);
  }
}

TEST(InverseDepth, IsSeenWhereItsPointIsSeen) {
  RandomStream random(4, StreamPurpose::kWorld);
  for (int i = 0; i < 200; ++i) {
    const TwoViews v(random);
    const auto pose = v.s.camera.pose(to_pose(v.x_second));
    const auto as_point = observe_point(v.s.camera, pose, v.s.p_world);
    const auto h = observe_inverse_depth(v.s.camera, pose, v.point);
    ASSERT_EQ(as_point.has_value(), h.has_value());
    if (!h) continue;
    EXPECT_TRUE(matrix_near(h->predicted, as_point->predicted, 1e-7));
    EXPECT_TRUE(matrix_near(h->p_camera, v.point.y[4] * as_point->p_camera, 1e-9));
  }
}

TEST(InverseDepth, JacobiansAgreeWithCentralDifferences) {
  RandomStream random(5, StreamPurpose::kWorld);
  int seen = 0;
  for (int i = 0; i < 300; ++i) {
    const TwoViews v(random);
    const Camera& camera = v.s.camera;
    const auto pose = camera.pose(to_pose(v.x_second));
    const auto h = observe_inverse_depth(camera, pose, v.point);
    if (!h || h->p_camera.z() < 0.2) continue;  // near the camera's plane pixels run away
    ++seen;
    const auto by_pose = [&](const Eigen::Vector3d& x) {
      return observe_inverse_depth(camera, camera.pose(to_pose(x)), v.point)->predicted;
    };
    const auto by_landmark = [&](const InverseDepthPoint::Parameters& y) {
      return observe_inverse_depth(camera, pose, {y, v.point.anchor_z_m})->predicted;
    };
    const auto as_point = [&](const InverseDepthPoint::Parameters& y) {
      return InverseDepthPoint{y, v.point.anchor_z_m}.p_world();
    };
    EXPECT_TRUE(matrix_near(h->H_pose, numeric_jacobian(by_pose, v.x_second), kJacobianTolerance));
    EXPECT_TRUE(matrix_near(h->H_landmark, numeric_jacobian(by_landmark, v.point.y), kJacobianTolerance));
    EXPECT_TRUE(matrix_near(v.point.jacobian(), numeric_jacobian(as_point, v.point.y), 1e-4));
  }
  EXPECT_GT(seen, 200);
}

TEST(InverseDepth, NewPointDependsOnPoseAndPixelAsItsJacobiansSay) {
  RandomStream random(6, StreamPurpose::kWorld);
  for (int i = 0; i < 300; ++i) {
    const Scene s(random);
    const auto made = locate_inverse_depth(s.camera, s.pose, s.pixel, 0.5);
    ASSERT_TRUE(made);
    const auto change = [&](const CameraPose& pose, const Eigen::Vector2d& pixel) {
      InverseDepthPoint::Parameters dy =
          locate_inverse_depth(s.camera, pose, pixel, 0.5)->point.y - made->point.y;
      dy[2] = wrap_angle(dy[2]);
      return dy;
    };
    const auto by_pose = [&](const Eigen::Vector3d& x) { return change(s.camera.pose(to_pose(x)), s.pixel); };
    const auto by_pixel = [&](const Eigen::Vector2d& pixel) { return change(s.pose, pixel); };
    EXPECT_TRUE(matrix_near(made->G_pose, numeric_jacobian(by_pose, to_vector(s.T_world_robot)), 1e-7));
    EXPECT_TRUE(matrix_near(made->G_pixel, numeric_jacobian(by_pixel, s.pixel, 1e-4), 1e-7));
  }
}

TEST(InverseDepth, APointAtInfinityIsSeenAlongItsRayFromAnywhere) {
  const Camera camera;
  const InverseDepthPoint point{{1.0, 2.0, 0.1, 0.05, 0.0}, 0.3};
  const auto here = observe_inverse_depth(camera, camera.pose({1.0, 2.0, 0.2}), point);
  const auto there = observe_inverse_depth(camera, camera.pose({9.0, -7.0, 0.2}), point);
  ASSERT_TRUE(here && there);
  EXPECT_TRUE(matrix_near(here->predicted, there->predicted, 1e-9));
  EXPECT_TRUE(here->H_landmark.allFinite());
}

TEST(InverseDepth, LinearityIndexIsItsFormulaAndFallsWithParallax) {
  // First seen from the origin along x at 4 m, then from the side under a parallax of 45 degrees.
  const InverseDepthPoint point{{0.0, 0.0, 0.0, 0.0, 0.25}, 0.3};
  const double ahead = linearity_index(point, 0.05, {0.0, 0.0, 0.3});
  const double aside = linearity_index(point, 0.05, {0.0, 4.0, 0.3});
  EXPECT_NEAR(ahead, 4.0 * 0.05 * 16.0 / 4.0, 1e-12);
  EXPECT_NEAR(aside, ahead * std::sqrt(0.5) / std::sqrt(2.0), 1e-12);
}

}  // namespace
}  // namespace waymark
