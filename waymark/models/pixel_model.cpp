#include "waymark/models/pixel_model.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace waymark {
namespace {

struct Direction {
  Eigen::Vector3d m, m_phi, m_psi;  ///< and its derivatives
};

Direction direction_of(double phi_rad, double psi_rad) {
  const double c_phi = std::cos(phi_rad), s_phi = std::sin(phi_rad);
  const double c_psi = std::cos(psi_rad), s_psi = std::sin(psi_rad);
  return {{c_psi * c_phi, c_psi * s_phi, s_psi},
          {-c_psi * s_phi, c_psi * c_phi, 0.0},
          {-s_psi * c_phi, -s_psi * s_phi, c_psi}};
}

}  // namespace

std::optional<PixelLinearization<3>> observe_point(const Camera& camera, const CameraPose& camera_pose,
                                                   const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d from_camera = p_world - camera_pose.p_world_camera;
  const Eigen::Vector3d p_camera = camera_pose.R_camera_world * from_camera;
  if (!(p_camera.z() > kMinDepth_m)) return std::nullopt;
  const auto image = camera.project(p_camera);
  if (!image) return std::nullopt;
  PixelLinearization<3> h;
  h.predicted = image->pixel;
  h.p_camera = p_camera;
  h.H_landmark = image->dpixel_dpoint * camera_pose.R_camera_world;
  h.H_pose = -h.H_landmark * camera_pose.dp_dpose;
  h.H_pose.col(2) += image->dpixel_dpoint * (camera_pose.dR_camera_world_dth * from_camera);
  return h;
}

Eigen::Vector3d InverseDepthPoint::direction() const { return direction_of(y[2], y[3]).m; }

Eigen::Matrix<double, 3, 5> InverseDepthPoint::jacobian() const {
  const auto [m, m_phi, m_psi] = direction_of(y[2], y[3]);
  const double rho = y[4];
  Eigen::Matrix<double, 3, 5> J;
  J << Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), m_phi / rho, m_psi / rho, -m / (rho * rho);
  return J;
}

std::optional<PixelLinearization<5>> observe_inverse_depth(const Camera& camera,
                                                           const CameraPose& camera_pose,
                                                           const InverseDepthPoint& point) {
  const auto [m, m_phi, m_psi] = direction_of(point.y[2], point.y[3]);
  const double rho = point.y[4];
  const Eigen::Matrix3d& R = camera_pose.R_camera_world;
  const Eigen::Vector3d baseline = point.anchor() - camera_pose.p_world_camera;
  const Eigen::Vector3d w = rho * baseline + m;
  const Eigen::Vector3d ray = R * w;
  const auto image = camera.project(ray);
  if (!image) return std::nullopt;
  PixelLinearization<5> h;
  h.predicted = image->pixel;
  h.p_camera = ray;
  const Eigen::Matrix<double, 2, 3> dpixel_dw = image->dpixel_dpoint * R;
  Eigen::Matrix<double, 3, 5> dw_dy;
  dw_dy << rho * Eigen::Vector3d::UnitX(), rho * Eigen::Vector3d::UnitY(), m_phi, m_psi, baseline;
  h.H_landmark = dpixel_dw * dw_dy;
  h.H_pose = -rho * dpixel_dw * camera_pose.dp_dpose;
  h.H_pose.col(2) += image->dpixel_dpoint * (camera_pose.dR_camera_world_dth * w);
  return h;
}

std::optional<NewInverseDepthPoint> locate_inverse_depth(const Camera& camera, const CameraPose& camera_pose,
                                                         const Eigen::Vector2d& pixel, double rho_per_m) {
  const auto ray = camera.ray(pixel);
  if (!ray) return std::nullopt;
  const Eigen::Matrix3d R_world_camera = camera_pose.R_camera_world.transpose();
  const Eigen::Vector3d d = R_world_camera * ray->xy.homogeneous();
  const double ground2 = d.head<2>().squaredNorm(), ground = std::sqrt(ground2);
  Eigen::Matrix<double, 2, 3> dangles_dd;                // (phi, psi) = (atan2(d_y, d_x), atan2(d_z, ground))
  dangles_dd << -d.y() / ground2, d.x() / ground2, 0.0,  //
      -d.x() * d.z() / ground, -d.y() * d.z() / ground, ground;
  dangles_dd.row(1) /= d.squaredNorm();
  NewInverseDepthPoint made;
  const Eigen::Vector3d& c = camera_pose.p_world_camera;
  made.point = {{c.x(), c.y(), std::atan2(d.y(), d.x()), std::atan2(d.z(), ground), rho_per_m}, c.z()};
  made.G_pose.setZero();
  made.G_pose.topRows<2>() = camera_pose.dp_dpose.topRows<2>();
  made.G_pose(2, 2) = 1.0;  // turning the robot turns the ray about the vertical, and does nothing else
  made.G_pixel.setZero();
  made.G_pixel.middleRows<2>(2) = dangles_dd * R_world_camera.leftCols<2>() * ray->dxy_dpixel;
  return made;
}

double linearity_index(const InverseDepthPoint& point, double rho_sigma_per_m,
                       const Eigen::Vector3d& p_world_camera) {
  const Eigen::Vector3d from_camera = point.p_world() - p_world_camera;
  const double depth_sigma_m = rho_sigma_per_m / (point.y[4] * point.y[4]);
  const double distance_m = from_camera.norm();
  const double cos_parallax = point.direction().dot(from_camera) / distance_m;
  return 4.0 * depth_sigma_m * std::abs(cos_parallax) / distance_m;
}

}  // namespace waymark
