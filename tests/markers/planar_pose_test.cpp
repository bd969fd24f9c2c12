#include "waymark/markers/planar_pose.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/numeric_jacobian.hpp"

#include "drawn_marker.hpp"

namespace waymark::markers {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Vector8d = Eigen::Matrix<double, 8, 1>;
constexpr double kSide_m = 0.2;

MarkerPose moved(const MarkerPose& pose, const Vector6d& step) {
  MarkerPose result = pose;
  const double turn_rad = step.head<3>().norm();
  if (turn_rad > 0.0)
    result.R_camera_marker =
        Eigen::AngleAxisd(turn_rad, step.head<3>() / turn_rad).toRotationMatrix() * pose.R_camera_marker;
  result.p_camera_marker += step.tail<3>();
  return result;
}

/// Turn (about the camera's axes) and shift from one pose to another.
Vector6d difference(const MarkerPose& from, const MarkerPose& to) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(to.R_camera_marker * from.R_camera_marker.transpose()));
  Vector6d d;
  d << turn.angle() * turn.axis(), to.p_camera_marker - from.p_camera_marker;
  return d;
}

TEST(PlanarPose, JacobianIsThatOfTheReprojection) {
  const Camera camera(test::marker_camera());
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 20; ++i) {
    const MarkerPose pose = test::random_marker_pose(random, 1.2);
    const auto numeric = test::numeric_jacobian(
        [&](const Vector6d& step) -> Vector8d {
          return reproject(camera, moved(pose, step), kSide_m)->pixels;
        },
        Vector6d(Vector6d::Zero()));
    EXPECT_TRUE(test::matrix_near(reproject(camera, pose, kSide_m)->dpixels_dpose, numeric, 1e-4));
  }
}

TEST(PlanarPose, OfExactCornersIsExact) {
  const Camera camera(test::marker_camera());
  RandomStream random(2, StreamPurpose::kWorld);
  for (int i = 0; i < 200; ++i) {
    const MarkerPose truth = test::random_marker_pose(random, 1.2);
    const RefinedCorners corners{test::corners_of(camera, truth, kSide_m), CornerCovariance::Identity()};
    const auto poses = estimate_marker_poses(camera, corners, kSide_m);
    ASSERT_TRUE(poses.has_value());
    EXPECT_LT(poses->best.error, 1e-9);
    EXPECT_LE(poses->best.error, poses->other.error);
    EXPECT_LT(difference(truth, poses->best).norm(), 1e-4) << i;
  }
}

/// No small step makes either better by as much as rounding of a pixel.
TEST(PlanarPose, BothAreMinima) {
  const Camera camera(test::marker_camera());
  RandomStream random(3, StreamPurpose::kWorld);
  for (int i = 0; i < 50; ++i) {
    const MarkerPose truth = test::random_marker_pose(random, 1.0);
    RefinedCorners corners{test::corners_of(camera, truth, kSide_m), CornerCovariance::Identity()};
    Vector8d z;
    for (std::size_t k = 0; k < 4; ++k) {
      corners.corners_px[k] += Eigen::Vector2d(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1));
      z.segment<2>(static_cast<Eigen::Index>(2 * k)) = corners.corners_px[k];
    }
    const auto poses = estimate_marker_poses(camera, corners, kSide_m);
    ASSERT_TRUE(poses.has_value());
    for (const MarkerPose& pose : {poses->best, poses->other})
      for (Eigen::Index axis = 0; axis < 6; ++axis)
        for (const double step : {1e-4, -1e-4}) {
          const Vector8d r = z - reproject(camera, moved(pose, step * Vector6d::Unit(axis)), kSide_m)->pixels;
          EXPECT_GE(r.squaredNorm(), pose.error - 1e-3);
        }
  }
}

/// Errors of poses from noisy corners, measured by the information: chi-square with 6 degrees of freedom
/// where the pose is well determined.
TEST(PlanarPose, InformationIsHonest) {
  const Camera camera(test::marker_camera());
  RandomStream random(4, StreamPurpose::kWorld);
  constexpr double kNoise_px = 0.02;
  constexpr int kDraws = 500;
  MarkerPose truth;
  truth.p_camera_marker = {0.2, -0.1, 1.2};
  truth.R_camera_marker = Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitY()).toRotationMatrix();
  double sum = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    RefinedCorners corners{test::corners_of(camera, truth, kSide_m),
                           kNoise_px * kNoise_px * CornerCovariance::Identity()};
    for (auto& corner : corners.corners_px)
      corner += kNoise_px * Eigen::Vector2d(random.normal(), random.normal());
    const auto poses = estimate_marker_poses(camera, corners, kSide_m);
    ASSERT_TRUE(poses.has_value());
    const Vector6d e = difference(truth, poses->best);
    sum += e.dot(poses->best.information * e);
  }
  EXPECT_NEAR(sum / kDraws, 6.0, 0.75);  // five standard deviations of the mean
}

TEST(PlanarPose, NeedsASquareInFront) {
  const Camera camera(test::marker_camera());
  RefinedCorners corners{{}, CornerCovariance::Identity()};
  corners.corners_px.fill(Eigen::Vector2d(100.0, 100.0));
  EXPECT_FALSE(estimate_marker_poses(camera, corners, kSide_m).has_value());
  // Seen from behind: counter-clockwise.
  MarkerPose pose;
  pose.p_camera_marker = {0.0, 0.0, 2.0};
  corners.corners_px = test::corners_of(camera, pose, kSide_m);
  std::swap(corners.corners_px[1], corners.corners_px[3]);
  EXPECT_FALSE(estimate_marker_poses(camera, corners, kSide_m).has_value());
}

}  // namespace
}  // namespace waymark::markers
