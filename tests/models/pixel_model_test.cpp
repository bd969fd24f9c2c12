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

constexpr double kPixelTolerance = 1e-3;  // entries of some hundred to some thousand

/// A camera on a robot somewhere, and a point some metres away in its image.
struct PixelScene {
  explicit PixelScene(RandomStream& random)
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
    const PixelScene s(random);
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
    const PixelScene s(random);
    const auto h = observe_point(s.camera, s.pose, s.p_world);
    ASSERT_TRUE(h);
    const auto by_pose = [&](const Eigen::Vector3d& x) {
      return observe_point(s.camera, s.camera.pose(to_pose(x)), s.p_world)->predicted;
    };
    const auto by_point = [&](const Eigen::Vector3d& p) {
      return observe_point(s.camera, s.pose, p)->predicted;
    };
    EXPECT_TRUE(
        matrix_near(h->H_pose, numeric_jacobian(by_pose, to_vector(s.T_world_robot)), kPixelTolerance));
    EXPECT_TRUE(matrix_near(h->H_landmark, numeric_jacobian(by_point, s.p_world), kPixelTolerance));
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
    const Eigen::Vector3d p_camera = s.pose.R_camera_world * (s.p_world - s.pose.p_world_camera);
    ray << p_camera.head<2>() / p_camera.z(), 1.0 / p_camera.z();
    x_second = to_vector(s.T_world_robot);
    for (auto& x : x_second) x += random.uniform(-0.1, 0.1);
  }

  PixelScene s;
  Eigen::Vector3d ray;
  Eigen::Vector3d x_second;
};

TEST(RayObservation, IsSeenWhereItsPointIsSeen) {
  RandomStream random(4, StreamPurpose::kWorld);
  for (int i = 0; i < 200; ++i) {
    const TwoViews v(random);
    EXPECT_TRUE(matrix_near(point_of_ray(v.s.pose, v.ray).p_world, v.s.p_world, 1e-9));
    const auto pose = v.s.camera.pose(to_pose(v.x_second));
    const auto as_point = observe_point(v.s.camera, pose, v.s.p_world);
    const auto h = observe_ray(v.s.camera, pose, v.s.pose, v.ray);
    ASSERT_EQ(as_point.has_value(), h.has_value());
    if (!h) continue;
    EXPECT_TRUE(matrix_near(h->predicted, as_point->predicted, 1e-7));
    EXPECT_TRUE(matrix_near(h->p_camera, v.ray[2] * as_point->p_camera, 1e-9));
  }
}

TEST(RayObservation, JacobiansAgreeWithCentralDifferences) {
  RandomStream random(5, StreamPurpose::kWorld);
  int seen = 0;
  for (int i = 0; i < 300; ++i) {
    const TwoViews v(random);
    const Camera& camera = v.s.camera;
    const auto pose = camera.pose(to_pose(v.x_second));
    const auto h = observe_ray(camera, pose, v.s.pose, v.ray);
    if (!h || h->p_camera.z() < 0.2) continue;  // near the camera's plane pixels run away
    ++seen;
    const auto by_pose = [&](const Eigen::Vector3d& x) {
      return observe_ray(camera, camera.pose(to_pose(x)), v.s.pose, v.ray)->predicted;
    };
    const auto by_anchor = [&](const Eigen::Vector3d& x) {
      return observe_ray(camera, pose, camera.pose(to_pose(x)), v.ray)->predicted;
    };
    const auto by_ray = [&](const Eigen::Vector3d& ray) {
      return observe_ray(camera, pose, v.s.pose, ray)->predicted;
    };
    const Eigen::Vector3d x_first = to_vector(v.s.T_world_robot);
    EXPECT_TRUE(matrix_near(h->H_pose, numeric_jacobian(by_pose, v.x_second), kPixelTolerance));
    EXPECT_TRUE(matrix_near(h->H_anchor, numeric_jacobian(by_anchor, x_first), kPixelTolerance));
    EXPECT_TRUE(matrix_near(h->H_ray, numeric_jacobian(by_ray, v.ray), kPixelTolerance));
  }
  EXPECT_GT(seen, 200);
}

TEST(RayObservation, PointDependsOnAnchorAndRayAsItsJacobiansSay) {
  RandomStream random(6, StreamPurpose::kWorld);
  for (int i = 0; i < 300; ++i) {
    const TwoViews v(random);
    const auto by_anchor = [&](const Eigen::Vector3d& x) {
      return point_of_ray(v.s.camera.pose(to_pose(x)), v.ray).p_world;
    };
    const auto by_ray = [&](const Eigen::Vector3d& ray) { return point_of_ray(v.s.pose, ray).p_world; };
    const RayPoint point = point_of_ray(v.s.pose, v.ray);
    EXPECT_TRUE(matrix_near(point.J_anchor, numeric_jacobian(by_anchor, to_vector(v.s.T_world_robot)), 1e-5));
    EXPECT_TRUE(matrix_near(point.J_ray, numeric_jacobian(by_ray, v.ray), 1e-4));
  }
}

TEST(RayObservation, APointAtInfinityIsSeenAlongItsRayFromAnywhere) {
  const Camera camera;
  const Eigen::Vector3d ray(0.1, 0.05, 0.0);
  const auto anchor = camera.pose({1.0, 2.0, 0.2});
  const auto here = observe_ray(camera, anchor, anchor, ray);
  const auto there = observe_ray(camera, camera.pose({9.0, -7.0, 0.2}), anchor, ray);
  ASSERT_TRUE(here && there);
  EXPECT_TRUE(matrix_near(here->predicted, there->predicted, 1e-9));
  EXPECT_TRUE(here->H_ray.allFinite());
}

TEST(RayObservation, LinearityIndexIsItsFormulaAndFallsWithParallax) {
  // First seen from the origin along x at 4 m, then from the side under a parallax of 45 degrees.
  const Camera camera;
  const CameraPose anchor = camera.pose({});
  const Eigen::Vector3d ray(0.0, 0.0, 0.25);
  const double ahead = linearity_index(anchor, ray, 0.05, anchor.p_world_camera);
  const double aside =
      linearity_index(anchor, ray, 0.05, anchor.p_world_camera + Eigen::Vector3d(0.0, 4.0, 0.0));
  EXPECT_NEAR(ahead, 4.0 * 0.05 * 16.0 / 4.0, 1e-12);
  EXPECT_NEAR(aside, ahead * std::sqrt(0.5) / std::sqrt(2.0), 1e-12);
}

}  // namespace
}  // namespace waymark
