#include "waymark/models/camera.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace waymark {
namespace {

/// The first s = x^2 + y^2 at which the distorted radius r g(r^2) no longer grows; infinite for most lenses.
double turning_radius2(const Distortion& d) {
  constexpr double kStep = 1e-3, kFar = 25.0;  // 25: 79 degrees off the axis
  for (double s = 0.0; s < kFar; s += kStep)
    if (1.0 + s * (3.0 * d.k1 + s * (5.0 * d.k2 + s * 7.0 * d.k3)) <= 0.0) return s;
  return std::numeric_limits<double>::infinity();
}

}  // namespace

Eigen::Matrix3d CameraMount::R_robot_camera() const {
  const Eigen::Matrix3d ahead{{0.0, 0.0, 1.0}, {-1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}};
  const auto about = [](double degrees, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(to_radians(degrees), axis).toRotationMatrix();
  };
  return about(yaw_deg, Eigen::Vector3d::UnitZ()) * about(pitch_deg, Eigen::Vector3d::UnitY()) *
         about(roll_deg, Eigen::Vector3d::UnitX()) * ahead;
}

CameraMount camera_mount(const Eigen::Matrix3d& R_robot_camera, const Eigen::Vector3d& p_robot_camera) {
  constexpr double kPole = 1e-9;  // of the cosine of the pitch: the error that it makes
  const Eigen::Matrix3d R = R_robot_camera * CameraMount{}.R_robot_camera().transpose();
  const double cos_pitch = std::hypot(R(0, 0), R(1, 0));
  const bool is_at_pole = cos_pitch < kPole;
  return {.x_m = p_robot_camera.x(),
          .y_m = p_robot_camera.y(),
          .z_m = p_robot_camera.z(),
          .roll_deg = is_at_pole ? 0.0 : to_degrees(std::atan2(R(2, 1), R(2, 2))),
          .pitch_deg = to_degrees(std::atan2(-R(2, 0), cos_pitch)),
          .yaw_deg = to_degrees(is_at_pole ? std::atan2(-R(0, 1), R(1, 1)) : std::atan2(R(1, 0), R(0, 0)))};
}

Camera::Camera(const CameraOptions& options)
    : options_(options),
      R_camera_robot_(options.mount.R_robot_camera().transpose()),
      p_robot_camera_(options.mount.p_robot_camera()),
      max_radius2_(turning_radius2(options.distortion)) {}

Eigen::Vector2d Camera::distort(const Eigen::Vector2d& xy) const {
  const Distortion& d = options_.distortion;
  const double x = xy.x(), y = xy.y(), s = xy.squaredNorm();
  const double g = 1.0 + s * (d.k1 + s * (d.k2 + s * d.k3));
  return {g * x + 2.0 * d.p1 * x * y + d.p2 * (s + 2.0 * x * x),
          g * y + d.p1 * (s + 2.0 * y * y) + 2.0 * d.p2 * x * y};
}

Eigen::Matrix2d Camera::distortion_jacobian(const Eigen::Vector2d& xy) const {
  const Distortion& d = options_.distortion;
  const double x = xy.x(), y = xy.y(), s = xy.squaredNorm();
  const double g = 1.0 + s * (d.k1 + s * (d.k2 + s * d.k3));
  const double dg = 2.0 * (d.k1 + s * (2.0 * d.k2 + s * 3.0 * d.k3));  // dg/dx = dg * x, dg/dy = dg * y
  const double cross = dg * x * y + 2.0 * (d.p1 * x + d.p2 * y);
  return Eigen::Matrix2d{{g + dg * x * x + 2.0 * d.p1 * y + 6.0 * d.p2 * x, cross},
                         {cross, g + dg * y * y + 6.0 * d.p1 * y + 2.0 * d.p2 * x}};
}

std::optional<Projection> Camera::project(const Eigen::Vector3d& p_camera) const {
  const double Z = p_camera.z();
  if (!(Z > 0.0)) return std::nullopt;
  const Eigen::Vector2d xy = p_camera.head<2>() / Z;
  if (!(xy.squaredNorm() < max_radius2_)) return std::nullopt;
  const Eigen::Vector2d f(options_.fu_px, options_.fv_px), c(options_.cu_px, options_.cv_px);
  Projection image;
  image.pixel = f.cwiseProduct(distort(xy)) + c;  // Vincke (7)
  const Eigen::Matrix2d dpixel_dxy = f.asDiagonal() * distortion_jacobian(xy);
  image.dpixel_dpoint << dpixel_dxy / Z, dpixel_dxy * (-xy / Z);
  return image;
}

std::optional<PixelRay> Camera::ray(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d f(options_.fu_px, options_.fv_px), c(options_.cu_px, options_.cv_px);
  const Eigen::Vector2d distorted = (pixel - c).cwiseQuotient(f);
  constexpr int kMaxIterations = 20;
  Eigen::Vector2d xy = distorted;
  for (int i = 0; i < kMaxIterations; ++i) {
    // Beyond the turning radius the polynomial has other solutions: start again nearer to the axis.
    if (!(xy.squaredNorm() < max_radius2_)) xy *= 0.7 * std::sqrt(max_radius2_) / xy.norm();
    const Eigen::Matrix2d inverse = distortion_jacobian(xy).inverse();
    const Eigen::Vector2d error = distorted - distort(xy);
    if (error.squaredNorm() < 1e-24) return PixelRay{xy, inverse * f.cwiseInverse().asDiagonal()};
    xy += inverse * error;
  }
  return std::nullopt;
}

bool Camera::sees(const Eigen::Vector2d& pixel, double border_px) const {
  return pixel.x() >= border_px && pixel.y() >= border_px && pixel.x() <= options_.width_px - 1 - border_px &&
         pixel.y() <= options_.height_px - 1 - border_px;
}

CameraPose Camera::pose(const Pose2& T_world_robot) const {
  Eigen::Matrix3d R_world_robot = Eigen::Matrix3d::Identity();
  R_world_robot.topLeftCorner<2, 2>() = T_world_robot.rotation();
  const Eigen::Vector3d offset = R_world_robot * p_robot_camera_;
  const Eigen::Matrix3d turn{{0.0, -1.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};  // dR/dth = turn R
  CameraPose pose;
  pose.R_camera_world = R_camera_robot_ * R_world_robot.transpose();
  pose.p_world_camera = offset + Eigen::Vector3d(T_world_robot.x_m, T_world_robot.y_m, 0.0);  // Vincke (9)
  pose.dp_dpose << Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), turn * offset;
  pose.dR_camera_world_dth = pose.R_camera_world * turn.transpose();
  return pose;
}

}  // namespace waymark
