#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace waymark {

/// The lens of monoslam-desk: camera x left, y up, z forward; a point at the undistorted offset r from the
/// centre is seen at r / sqrt(1 + 2 k r^2) (Davison, Reid, Molton, Stasse 2007).
struct WideAngleLens {
  double f_px = 195.0;
  Eigen::Vector2d centre_px{162.0, 125.0};
  double k_per_px2 = 9e-6;

  /// Nothing behind the camera.
  [[nodiscard]] std::optional<Eigen::Vector2d> pixel(const Eigen::Vector3d& p_camera) const;
  /// (x / z, y / z) of what is seen there.
  [[nodiscard]] Eigen::Vector2d ray(const Eigen::Vector2d& pixel) const;
};

/// Where a hand holds a camera: six degrees of freedom, and the covariance of (turn, position) in the world.
struct HandHeld {
  Eigen::Matrix3d R_camera_world = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_world_camera = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();

  [[nodiscard]] Eigen::Vector3d to_camera(const Eigen::Vector3d& p_world) const {
    return R_camera_world * (p_world - p_world_camera);
  }
  [[nodiscard]] Eigen::Vector3d to_world(const Eigen::Vector3d& p_camera) const {
    return p_world_camera + R_camera_world.transpose() * p_camera;
  }
  [[nodiscard]] HandHeld moved(const Eigen::Matrix<double, 6, 1>& step) const;
};

/// A point that is known, and where it is seen.
struct KnownObservation {
  Eigen::Vector3d p_world;
  Eigen::Vector2d pixel;
};

/// The place from which known points look like this, by Gauss-Newton from `start`; nothing where it does not
/// settle or leaves an RMS of more than 3 sigma. At least three observations.
[[nodiscard]] std::optional<HandHeld> resect(const WideAngleLens& lens, const HandHeld& start,
                                             std::span<const KnownObservation> observations, double sigma_px);

/// A place in an image.
struct PlaceIn {
  std::size_t image;
  Eigen::Vector2d pixel;
};

/// A point that is known, and where it is seen.
struct KnownTrack {
  Eigen::Vector3d p_world;
  std::vector<PlaceIn> places;
};

/// A point on the ray (x, y, 1) of the camera of one image, and where others show it.
struct RayTrack {
  std::size_t anchor;
  Eigen::Vector2d xy;
  double rho_per_m;
  std::vector<PlaceIn> places;
};

/// Places of the camera (but the first, which stays) and depths by which all that is seen fits best:
/// Levenberg's steps with Huber's weights. Corrects both; returns the RMS of what is left, px.
double bundle(const WideAngleLens& lens, std::span<HandHeld> cameras, std::span<const KnownTrack> known,
              std::span<RayTrack> tracks);

}  // namespace waymark
