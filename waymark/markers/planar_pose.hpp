#pragma once

#include <optional>

#include <Eigen/Core>

#include "waymark/markers/corners.hpp"
#include "waymark/models/camera.hpp"

namespace waymark::markers {

/// Where a marker is as its camera sees it. Marker axes: x to the right of the pattern, y down, z into the
/// wall, so that a marker seen face to face has R = I. Origin in the middle.
struct MarkerPose {
  Eigen::Matrix3d R_camera_marker = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_camera_marker = Eigen::Vector3d::Zero();
  /// Reprojection error of the corners, r' C^-1 r with the covariance C that came with them.
  double error = 0.0;
  /// Of (turn of R about the camera's axes, p), J' C^-1 J.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Four corners fit two poses, which tell the marker's tilt apart by perspective alone: the better one first.
struct MarkerPoses {
  MarkerPose best;
  MarkerPose other;
};

/// Both poses of a square with sides of `size_m`: from the homography of its corners (Collins and Bartoli,
/// "Infinitesimal plane-based pose estimation", IJCV 2014), each refined by Gauss-Newton steps on the
/// reprojection error through the lens. Nothing where the corners span no square in front of the camera. Some
/// 10 us.
[[nodiscard]] std::optional<MarkerPoses> estimate_marker_poses(const Camera& camera,
                                                               const RefinedCorners& corners, double size_m);

/// The corners in marker axes, m.
[[nodiscard]] std::array<Eigen::Vector3d, 4> marker_corners_m(double size_m);

/// Reprojected corners, px, stacked, and their Jacobian to (turn of R about the camera's axes, p). Nothing
/// where one is not in front of the camera.
struct Reprojection {
  Eigen::Matrix<double, 8, 1> pixels;
  Eigen::Matrix<double, 8, 6> dpixels_dpose;
};
[[nodiscard]] std::optional<Reprojection> reproject(const Camera& camera, const MarkerPose& pose,
                                                    double size_m);

}  // namespace waymark::markers
