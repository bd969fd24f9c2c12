#pragma once

#include <optional>

#include <Eigen/Core>

#include "waymark/core/pose2.hpp"

namespace waymark {

/// Where a camera sits on the robot. With zero angles it looks ahead, its rows level; the angles turn about
/// the robot's x (roll), y (pitch, positive looks down) and z (yaw, positive looks left), applied in this
/// order.
struct CameraMount {
  double x_m = 0.0;  ///< ahead of the robot's origin
  double y_m = 0.0;  ///< left of it
  double z_m = 0.3;  ///< above the ground
  double roll_deg = 0.0;
  double pitch_deg = 0.0;
  double yaw_deg = 0.0;

  [[nodiscard]] Eigen::Vector3d p_robot_camera() const { return {x_m, y_m, z_m}; }
  /// Camera axes (x right, y down, z forward) as columns in robot axes (x forward, y left, z up).
  [[nodiscard]] Eigen::Matrix3d R_robot_camera() const;
};

/// The mount of a camera that is there. Straight up or down roll and yaw are one turn, which then is the yaw.
/// Every rotation comes back from R_robot_camera() to 1e-9.
[[nodiscard]] CameraMount camera_mount(const Eigen::Matrix3d& R_robot_camera,
                                       const Eigen::Vector3d& p_robot_camera);

/// "Plumb bob" lens distortion as in ROS camera_info: radial k1, k2, k3 and tangential p1, p2.
struct Distortion {
  double k1 = 0.0;
  double k2 = 0.0;
  double p1 = 0.0;
  double p2 = 0.0;
  double k3 = 0.0;
};

/// A camera as a log or a config describes it. The default is 320 x 240 pixels with a horizontal field of
/// view of 60 degrees.
struct CameraOptions {
  int width_px = 320;
  int height_px = 240;
  double fu_px = 277.0;
  double fv_px = 277.0;
  double cu_px = 159.5;  ///< of the principal point; the centre of the first pixel is (0, 0)
  double cv_px = 119.5;
  Distortion distortion;
  CameraMount mount;
};

/// Where the camera is in the world, and how it depends on the robot's pose (x, y, theta).
struct CameraPose {
  Eigen::Matrix3d R_camera_world;
  Eigen::Vector3d p_world_camera;
  Eigen::Matrix3d dp_dpose;             ///< of p_world_camera
  Eigen::Matrix3d dR_camera_world_dth;  ///< of R_camera_world
};

/// A point's image and its Jacobian (2x3) to the point in the camera frame.
struct Projection {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> dpixel_dpoint;
};

/// The inverse: the ray (x, y, 1) through a pixel and d(x, y)/d(u, v).
struct PixelRay {
  Eigen::Vector2d xy;
  Eigen::Matrix2d dxy_dpixel;
};

/// Pinhole camera with plumb-bob distortion, fixed to a robot on the plane z = 0:
///
///     x = X/Z, y = Y/Z, s = x^2 + y^2, g = 1 + k1 s + k2 s^2 + k3 s^3
///     x_d = g x + 2 p1 x y + p2 (s + 2 x^2)        u = fu x_d + cu
///     y_d = g y + p1 (s + 2 y^2) + 2 p2 x y        v = fv y_d + cv
///
/// All functions are const, allocate nothing, and may be called from several threads.
class Camera {
 public:
  explicit Camera(const CameraOptions& options = {});

  [[nodiscard]] const CameraOptions& options() const { return options_; }
  [[nodiscard]] int width_px() const { return options_.width_px; }
  [[nodiscard]] int height_px() const { return options_.height_px; }

  /// The image of a point in the camera frame, in the image or beside it. Nothing for a point that is not
  /// in front of the camera, or so far off the axis that the lens polynomial has turned back. Depends on the
  /// direction of the point only (Jacobians scale with 1/distance).
  [[nodiscard]] std::optional<Projection> project(const Eigen::Vector3d& p_camera) const;

  /// The ray that is seen at a pixel, by Newton's method to 1e-12; nothing where no ray ends.
  [[nodiscard]] std::optional<PixelRay> ray(const Eigen::Vector2d& pixel) const;

  /// Is the pixel at least `border_px` inside the image?
  [[nodiscard]] bool sees(const Eigen::Vector2d& pixel, double border_px = 0.0) const;

  [[nodiscard]] CameraPose pose(const Pose2& T_world_robot) const;

 private:
  [[nodiscard]] Eigen::Vector2d distort(const Eigen::Vector2d& xy) const;
  [[nodiscard]] Eigen::Matrix2d distortion_jacobian(const Eigen::Vector2d& xy) const;

  CameraOptions options_;
  Eigen::Matrix3d R_camera_robot_;
  Eigen::Vector3d p_robot_camera_;
  double max_radius2_;  ///< of (x, y), up to where the radial polynomial rises
};

/// Nearer to the camera's plane than this nothing is seen.
inline constexpr double kMinDepth_m = 1e-3;

}  // namespace waymark
