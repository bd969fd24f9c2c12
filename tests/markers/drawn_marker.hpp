#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "waymark/core/grey_image.hpp"
#include "waymark/core/random.hpp"
#include "waymark/markers/planar_pose.hpp"
#include "waymark/models/camera.hpp"

#include "workbench/sim/marker_pattern.hpp"

namespace waymark::test {

/// 640 x 480 pixels with a lens that bends straight lines.
inline CameraOptions marker_camera() {
  CameraOptions o{
      .width_px = 640, .height_px = 480, .fu_px = 550.0, .fv_px = 560.0, .cu_px = 322.0, .cv_px = 236.0};
  o.distortion = {-0.12, 0.03, 0.0005, -0.0003, 0.0};
  o.mount = {0.1, -0.05, 0.5, 1.0, 4.0, 20.0};
  return o;
}

/// A marker that the camera can see whole: 1 to 3.5 m away, tilted by up to `tilt_rad`.
inline markers::MarkerPose random_marker_pose(RandomStream& random, double tilt_rad) {
  markers::MarkerPose pose;
  const double depth_m = random.uniform(1.0, 3.5);
  const double x_m = random.uniform(-0.4, 0.4) * depth_m, y_m = random.uniform(-0.25, 0.25) * depth_m;
  pose.p_camera_marker = {x_m, y_m, depth_m};
  const double about_rad = random.uniform(-3.1, 3.1), roll_rad = random.uniform(-3.1, 3.1);
  const Eigen::Vector3d axis(std::cos(about_rad), std::sin(about_rad), 0.0);
  pose.R_camera_marker = (Eigen::AngleAxisd(random.uniform(0.0, tilt_rad), axis) *
                          Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()))
                             .toRotationMatrix();
  return pose;
}

inline markers::Corners corners_of(const Camera& camera, const markers::MarkerPose& pose, double size_m) {
  const auto seen = markers::reproject(camera, pose, size_m);
  markers::Corners corners;
  for (std::size_t i = 0; i < 4; ++i) corners[i] = seen->pixels.segment<2>(static_cast<Eigen::Index>(2 * i));
  return corners;
}

/// What one ray through a pixel sees: marker `number` on white paper, on a grey wall without end.
inline double grey_behind(const Camera& camera, const markers::MarkerPose& pose, double size_m, int number,
                          const Eigen::Vector2d& pixel) {
  const Eigen::Vector3d ray = camera.ray(pixel)->xy.homogeneous();
  const Eigen::Vector3d normal = pose.R_camera_marker.col(2);
  const double depth_m = normal.dot(pose.p_camera_marker) / normal.dot(ray);
  const Eigen::Vector3d p = pose.R_camera_marker.transpose() * (depth_m * ray - pose.p_camera_marker);
  const double cell_m = size_m / sim::kMarkerBlackCells;
  const double half = 0.5 * sim::kMarkerCells;
  const int column = static_cast<int>(std::floor(p.x() / cell_m + half));
  const int row = static_cast<int>(std::floor(p.y() / cell_m + half));
  const bool on_paper = column >= 0 && row >= 0 && column < sim::kMarkerCells && row < sim::kMarkerCells;
  if (!on_paper) return 120.0;
  return sim::is_white(number, column, row) ? 210.0 : 25.0;
}

/// Paints a marker into an image by 6 x 6 rays per pixel.
inline void draw_marker(GreyImage& image, const Camera& camera, const markers::MarkerPose& pose,
                        double size_m, int number) {
  constexpr int kRays = 6;
  const auto paper = corners_of(camera, pose, 1.6 * size_m);
  Eigen::Vector2d low = paper[0], high = paper[0];
  for (const auto& corner : paper) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const auto inside = [](double value, int size) {
    return static_cast<int>(std::clamp(value, 0.0, size - 1.0));
  };
  for (int v = inside(low.y(), image.height_px()); v <= inside(high.y(), image.height_px()); ++v)
    for (int u = inside(low.x(), image.width_px()); u <= inside(high.x(), image.width_px()); ++u) {
      double sum = 0.0;
      for (int row = 0; row < kRays; ++row)
        for (int column = 0; column < kRays; ++column)
          sum += grey_behind(camera, pose, size_m, number,
                             {u + (column + 0.5) / kRays - 0.5, v + (row + 0.5) / kRays - 0.5});
      image(u, v) = static_cast<std::uint8_t>(std::lround(sum / (kRays * kRays)));
    }
}

}  // namespace waymark::test
