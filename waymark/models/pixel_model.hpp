#pragma once

#include <optional>

#include <Eigen/Core>

#include "waymark/core/pose2.hpp"
#include "waymark/models/camera.hpp"

namespace waymark {

/// A pixel observation linearised at a robot pose and a point.
struct PixelLinearization {
  Eigen::Vector2d predicted;                  ///< px
  Eigen::Matrix<double, 2, 3> H_pose;         ///< d(u, v)/d(x, y, theta) of the robot
  Eigen::Matrix<double, 2, 3> H_landmark;     ///< d(u, v)/d(x, y, z) of the point
  Eigen::Vector3d p_camera;                   ///< the point in the camera frame, m
  Eigen::Matrix<double, 2, 3> dpixel_dpoint;  ///< d(u, v)/d p_camera
};

/// A point in the world (x, y, z up) seen by a camera on a robot on the plane (Vincke et al. 2012, equations
/// 7 to 9, for any mount and lens): p_camera = R_camera_world (p - c). Nothing where it cannot be seen.
[[nodiscard]] std::optional<PixelLinearization> observe_point(const Camera& camera,
                                                              const CameraPose& camera_pose,
                                                              const Eigen::Vector3d& p_world);

/// A point by where it was first seen (Civera, Davison, Montiel 2008): ray = (x, y, rho) in the frame of the
/// camera of then, p = (x, y, 1)/rho. That camera stood on an anchor, a pose of the robot that all points
/// share that were first seen in one image. Seen from a camera with p_camera ~ R_cw [rho (c_anchor - c) +
/// R_wc_anchor (x, y, 1)]: finite down to rho = 0, a point at infinity.
struct RayLinearization {
  Eigen::Vector2d predicted;                  ///< px
  Eigen::Matrix<double, 2, 3> H_pose;         ///< d(u, v)/d(x, y, theta) of the robot
  Eigen::Matrix<double, 2, 3> H_anchor;       ///< d(u, v)/d(x, y, theta) of the robot then
  Eigen::Matrix<double, 2, 3> H_ray;          ///< d(u, v)/d(x, y, rho)
  Eigen::Vector3d p_camera;                   ///< rho times the point in the camera frame
  Eigen::Matrix<double, 2, 3> dpixel_dpoint;  ///< d(u, v)/d p_camera
};
[[nodiscard]] std::optional<RayLinearization> observe_ray(const Camera& camera, const CameraPose& camera_pose,
                                                          const CameraPose& anchor,
                                                          const Eigen::Vector3d& ray);

/// The point of a ray in the world, and its Jacobians to the anchor's (x, y, theta) and to the ray. rho must
/// be positive.
struct RayPoint {
  Eigen::Vector3d p_world;
  Eigen::Matrix3d J_anchor;
  Eigen::Matrix3d J_ray;
};
[[nodiscard]] RayPoint point_of_ray(const CameraPose& anchor, const Eigen::Vector3d& ray);

/// How far from linear the observation is within the uncertainty of rho (Civera, Davison, Montiel 2008):
/// L = 4 sigma_d |cos alpha| / d with sigma_d that of the distance from the anchor, alpha the parallax angle
/// and d the distance from the camera. Below 0.1 the point can be kept as (x, y, z).
[[nodiscard]] double linearity_index(const CameraPose& anchor, const Eigen::Vector3d& ray,
                                     double rho_sigma_per_m, const Eigen::Vector3d& p_world_camera);

}  // namespace waymark
