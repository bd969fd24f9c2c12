#include "waymark/markers/planar_pose.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "waymark/core/principal_axes.hpp"
#include "waymark/core/solve_symmetric.hpp"
#include "waymark/markers/homography.hpp"

namespace waymark::markers {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Vector8d = Eigen::Matrix<double, 8, 1>;
using Matrix8d = Eigen::Matrix<double, 8, 8>;

constexpr int kIterations = 20;
constexpr double kConverged = 1e-9;  // m and rad

/// Rays through the corners.
std::optional<Corners> rays_through(const Camera& camera, const Corners& corners_px) {
  Corners rays;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto ray = camera.ray(corners_px[i]);
    if (!ray) return std::nullopt;
    rays[i] = ray->xy;
  }
  return rays;
}

/// The least turn that takes the z axis to a direction, not that against it.
Matrix3d turn_from_z(const Vector3d& to) {
  const double s = std::sqrt(2.0 * (1.0 + to.z()));
  return Eigen::Quaterniond(0.5 * s, -to.y() / s, to.x() / s, 0.0).toRotationMatrix();
}

/// The two poses whose view of the marker's middle agrees with the homography to first order.
std::optional<std::array<MarkerPose, 2>> decompose(const Matrix3d& H) {
  const Vector2d v = H.block<2, 1>(0, 2);
  const Matrix2d J = H.topLeftCorner<2, 2>() - v * H.block<1, 2>(2, 0);
  const Vector3d towards(v.x(), v.y(), 1.0);
  const Matrix3d R_v = turn_from_z(towards.normalized());
  const Matrix2d B = R_v.topLeftCorner<2, 2>() - v * R_v.block<1, 2>(2, 0);
  const Matrix2d A = B.inverse() * J;
  const double inverse_depth = std::sqrt(principal_axes(A.transpose() * A).variances[1]);
  if (!(inverse_depth > 0.0) || !(A.determinant() > 0.0)) return std::nullopt;
  const Matrix2d R22 = A / inverse_depth;
  const Matrix2d rest = Matrix2d::Identity() - R22.transpose() * R22;
  const double b0 = std::sqrt(std::max(0.0, rest(0, 0)));
  const double b1 = std::copysign(std::sqrt(std::max(0.0, rest(1, 1))), rest(0, 1));
  std::array<MarkerPose, 2> poses;
  for (const double sign : {1.0, -1.0}) {
    const Vector3d x(R22(0, 0), R22(1, 0), sign * b0), y(R22(0, 1), R22(1, 1), sign * b1);
    Matrix3d R;
    R << x, y, x.cross(y);
    MarkerPose& pose = poses[sign > 0.0 ? 0 : 1];
    // Orthonormal to rounding only; the nearest rotation.
    pose.R_camera_marker = Eigen::Quaterniond(Matrix3d(R_v * R)).normalized().toRotationMatrix();
    pose.p_camera_marker = towards / inverse_depth;
  }
  return poses;
}

Vector8d stacked(const Corners& corners) {
  Vector8d z;
  z << corners[0], corners[1], corners[2], corners[3];
  return z;
}

MarkerPose moved(const MarkerPose& pose, const Vector6d& step) {
  MarkerPose result = pose;
  const double turn_rad = step.head<3>().norm();
  if (turn_rad > 0.0)
    result.R_camera_marker =
        Eigen::AngleAxisd(turn_rad, step.head<3>() / turn_rad).toRotationMatrix() * pose.R_camera_marker;
  result.p_camera_marker += step.tail<3>();
  return result;
}

/// Puts error and information of the pose as it is into it, and gives the step from there; nothing where the
/// marker is not in front of the camera.
std::optional<Vector6d> assess(const Camera& camera, const Vector8d& z, const Matrix8d& W, double size_m,
                               MarkerPose& pose) {
  const auto expected = reproject(camera, pose, size_m);
  if (!expected) return std::nullopt;
  const Vector8d r = z - expected->pixels;
  const Eigen::Matrix<double, 6, 8> JtW = expected->dpixels_dpose.transpose() * W;
  pose.error = r.dot(W * r);
  pose.information = JtW * expected->dpixels_dpose;
  return solve_symmetric(pose.information, JtW * r);
}

/// Gauss-Newton; a step that makes it worse is halved.
std::optional<MarkerPose> refine(const Camera& camera, const Vector8d& z, const Matrix8d& W, double size_m,
                                 MarkerPose pose) {
  auto step = assess(camera, z, W, size_m, pose);
  for (int i = 0; i < kIterations && step && step->norm() > kConverged; ++i) {
    MarkerPose next = moved(pose, *step);
    const auto next_step = assess(camera, z, W, size_m, next);
    if (next_step && next.error <= pose.error) {
      pose = next;
      step = next_step;
    } else {
      *step *= 0.5;
    }
  }
  return step && step->allFinite() ? std::optional(pose) : std::nullopt;
}

}  // namespace

std::array<Vector3d, 4> marker_corners_m(double size_m) {
  std::array<Vector3d, 4> corners;
  const Corners flat = corners_of_square(size_m);
  for (std::size_t i = 0; i < 4; ++i) corners[i] = {flat[i].x(), flat[i].y(), 0.0};
  return corners;
}

std::optional<Reprojection> reproject(const Camera& camera, const MarkerPose& pose, double size_m) {
  Reprojection result;
  Eigen::Index row = 0;
  for (const Vector3d& corner : marker_corners_m(size_m)) {
    const Vector3d arm = pose.R_camera_marker * corner;
    const auto image = camera.project(arm + pose.p_camera_marker);
    if (!image) return std::nullopt;
    const Matrix3d turn{{0.0, arm.z(), -arm.y()}, {-arm.z(), 0.0, arm.x()}, {arm.y(), -arm.x(), 0.0}};
    result.pixels.segment<2>(row) = image->pixel;
    result.dpixels_dpose.block<2, 3>(row, 0) = image->dpixel_dpoint * turn;
    result.dpixels_dpose.block<2, 3>(row, 3) = image->dpixel_dpoint;
    row += 2;
  }
  return result;
}

std::optional<MarkerPoses> estimate_marker_poses(const Camera& camera, const RefinedCorners& corners,
                                                 double size_m) {
  const auto rays = rays_through(camera, corners.corners_px);
  const auto H = rays ? homography_of_square(*rays, size_m) : std::nullopt;
  const auto starts = H ? decompose(*H) : std::nullopt;
  if (!starts) return std::nullopt;
  const Vector8d z = stacked(corners.corners_px);
  const Matrix8d W = solve_symmetric(corners.covariance, Matrix8d::Identity());
  const auto first = refine(camera, z, W, size_m, (*starts)[0]);
  const auto second = refine(camera, z, W, size_m, (*starts)[1]);
  if (!first || !second) return std::nullopt;
  MarkerPoses poses{*first, *second};
  if (poses.other.error < poses.best.error) std::swap(poses.best, poses.other);
  return poses;
}

}  // namespace waymark::markers
