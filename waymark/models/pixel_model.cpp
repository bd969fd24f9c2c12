#include "waymark/models/pixel_model.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace waymark {
std::optional<PixelLinearization> observe_point(const Camera& camera, const CameraPose& camera_pose,
                                                const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d from_camera = p_world - camera_pose.p_world_camera;
  const Eigen::Vector3d p_camera = camera_pose.R_camera_world * from_camera;  // Vincke (9)
  if (!(p_camera.z() > kMinDepth_m)) return std::nullopt;
  const auto image = camera.project(p_camera);
  if (!image) return std::nullopt;
  PixelLinearization h;
  h.predicted = image->pixel;  // Vincke (8)
  h.p_camera = p_camera;
  h.dpixel_dpoint = image->dpixel_dpoint;
  h.H_landmark = image->dpixel_dpoint * camera_pose.R_camera_world;
  h.H_pose = -h.H_landmark * camera_pose.dp_dpose;
  h.H_pose.col(2) += image->dpixel_dpoint * (camera_pose.dR_camera_world_dth * from_camera);
  return h;
}

std::optional<RayLinearization> observe_ray(const Camera& camera, const CameraPose& camera_pose,
                                            const CameraPose& anchor, const Eigen::Vector3d& ray) {
  const double rho = ray[2];
  const Eigen::Vector3d direction = ray.head<2>().homogeneous();
  const Eigen::Matrix3d R_world_anchor = anchor.R_camera_world.transpose();
  const Eigen::Vector3d baseline = anchor.p_world_camera - camera_pose.p_world_camera;
  const Eigen::Vector3d w = rho * baseline + R_world_anchor * direction;
  const Eigen::Vector3d p_camera = camera_pose.R_camera_world * w;
  const auto image = camera.project(p_camera);
  if (!image) return std::nullopt;
  const Eigen::Matrix<double, 2, 3> dpixel_dw = image->dpixel_dpoint * camera_pose.R_camera_world;
  RayLinearization h;
  h.predicted = image->pixel;
  h.p_camera = p_camera;
  h.dpixel_dpoint = image->dpixel_dpoint;
  h.H_pose = -rho * dpixel_dw * camera_pose.dp_dpose;
  h.H_pose.col(2) += image->dpixel_dpoint * (camera_pose.dR_camera_world_dth * w);
  h.H_anchor = rho * dpixel_dw * anchor.dp_dpose;
  h.H_anchor.col(2) += dpixel_dw * (anchor.dR_camera_world_dth.transpose() * direction);
  h.H_ray << dpixel_dw * R_world_anchor.leftCols<2>(), dpixel_dw * baseline;
  return h;
}

RayPoint point_of_ray(const CameraPose& anchor, const Eigen::Vector3d& ray) {
  const double depth_m = 1.0 / ray[2];
  const Eigen::Vector3d direction = ray.head<2>().homogeneous();
  const Eigen::Matrix3d R_world_anchor = anchor.R_camera_world.transpose();
  const Eigen::Vector3d from_camera = depth_m * (R_world_anchor * direction);
  RayPoint point;
  point.p_world = anchor.p_world_camera + from_camera;
  point.J_anchor = anchor.dp_dpose;
  point.J_anchor.col(2) += depth_m * (anchor.dR_camera_world_dth.transpose() * direction);
  point.J_ray << depth_m * R_world_anchor.leftCols<2>(), -depth_m * from_camera;
  return point;
}

double linearity_index(const CameraPose& anchor, const Eigen::Vector3d& ray, double rho_sigma_per_m,
                       const Eigen::Vector3d& p_world_camera) {
  const Eigen::Vector3d p_world = point_of_ray(anchor, ray).p_world;
  const Eigen::Vector3d from_anchor = p_world - anchor.p_world_camera;
  const Eigen::Vector3d from_camera = p_world - p_world_camera;
  const double distance_sigma_m = from_anchor.norm() * rho_sigma_per_m / ray[2];
  const double cos_parallax = from_anchor.normalized().dot(from_camera.normalized());
  return 4.0 * distance_sigma_m * std::abs(cos_parallax) / from_camera.norm();
}

}  // namespace waymark
