#pragma once

#include <optional>

#include <Eigen/Core>

#include "waymark/core/pose2.hpp"
#include "waymark/models/camera.hpp"

namespace waymark {

/// A pixel observation linearised at a robot pose and a landmark of Dim parameters.
template <int Dim>
struct PixelLinearization {
  Eigen::Vector2d predicted;                 ///< px
  Eigen::Matrix<double, 2, 3> H_pose;        ///< d(u, v)/d(x, y, theta) of the robot
  Eigen::Matrix<double, 2, Dim> H_landmark;  ///< d(u, v)/d(landmark)
  Eigen::Vector3d p_camera;                  ///< the landmark in the camera frame, m
};

/// A point in the world (x, y, z up) seen by a camera on a robot on the plane (Vincke et al. 2012, equations
/// 7 to 9, for any mount and lens): p_camera = R_camera_world (p - c). Nothing where it cannot be seen.
[[nodiscard]] std::optional<PixelLinearization<3>> observe_point(const Camera& camera,
                                                                 const CameraPose& camera_pose,
                                                                 const Eigen::Vector3d& p_world);

/// A point by the ray along which it was first seen and its inverse distance on it (Civera, Davison, Montiel
/// 2008): p = a + m/rho, m = (cos psi cos phi, cos psi sin phi, sin psi). The ray starts where the camera
/// was; its height is always that of the mount, so that five parameters do.
struct InverseDepthPoint {
  /// (a_x, a_y, phi, psi, rho): anchor in m, azimuth counter-clockwise from the world's x axis, elevation,
  /// 1/m.
  using Parameters = Eigen::Matrix<double, 5, 1>;

  Parameters y = Parameters::Zero();
  double anchor_z_m = 0.0;

  [[nodiscard]] Eigen::Vector3d anchor() const { return {y[0], y[1], anchor_z_m}; }
  [[nodiscard]] Eigen::Vector3d direction() const;
  /// Infinite where rho is 0.
  [[nodiscard]] Eigen::Vector3d p_world() const { return anchor() + direction() / y[4]; }
  /// d p_world / d y.
  [[nodiscard]] Eigen::Matrix<double, 3, 5> jacobian() const;
};

/// The same measurement of such a point: it stays finite down to rho = 0, a point at infinity. `p_camera` is
/// its direction, of length 1 at infinity: rho p_camera.
[[nodiscard]] std::optional<PixelLinearization<5>> observe_inverse_depth(const Camera& camera,
                                                                         const CameraPose& camera_pose,
                                                                         const InverseDepthPoint& point);

/// A new point on the ray of a pixel, and its Jacobians to the robot's pose, the pixel and rho.
struct NewInverseDepthPoint {
  InverseDepthPoint point;
  Eigen::Matrix<double, 5, 3> G_pose;
  Eigen::Matrix<double, 5, 2> G_pixel;  ///< and d y / d rho = (0, 0, 0, 0, 1)
};
[[nodiscard]] std::optional<NewInverseDepthPoint> locate_inverse_depth(const Camera& camera,
                                                                       const CameraPose& camera_pose,
                                                                       const Eigen::Vector2d& pixel,
                                                                       double rho_per_m);

/// How far from linear the observation is within the uncertainty of rho (Civera, Davison, Montiel 2008):
/// L = 4 sigma_d |cos alpha| / d with sigma_d = sigma_rho/rho^2, alpha the parallax angle and d the distance
/// from the camera. Below 0.1 the point can be kept as (x, y, z).
[[nodiscard]] double linearity_index(const InverseDepthPoint& point, double rho_sigma_per_m,
                                     const Eigen::Vector3d& p_world_camera);

}  // namespace waymark
