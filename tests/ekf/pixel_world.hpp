#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "waymark/core/map_state.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/core/pose2.hpp"
#include "waymark/ekf/bounded_map.hpp"
#include "waymark/ekf/pixel_prediction.hpp"
#include "waymark/ekf/pixel_slam_options.hpp"
#include "waymark/models/camera.hpp"

namespace waymark::test {

inline LandmarkId corner_id(int number) { return {LandmarkId::Family::kCorner, number}; }

/// A robot with a camera that starts at the origin and looks along x, and what the parts of its filter share.
struct PixelWorld {
  explicit PixelWorld(const PixelSlamOptions& options = {})
      : prediction(options, {.mount = {.x_m = 0.1, .z_m = 0.5}}), map(options, prediction.camera(), 1) {
    prediction.noise().begin_image(map.map().state());
  }

  /// The robot goes where it says it goes, but the filter does not know how well it does.
  void move(const Pose2& increment, double sigma = 0.01) {
    truth = truth * increment;
    map.map().state().predict({increment, sigma * sigma * Eigen::Matrix3d::Identity()});
  }

  /// Points that stand `sigma_m` from where the map has them, numbered from 0.
  void load(const std::vector<Eigen::Vector3d>& points, double sigma_m = 0.01) {
    MapState saved;
    saved.landmark_dimension = 3;
    const auto count = static_cast<Eigen::Index>(points.size());
    saved.landmarks.resize(3 * count);
    for (Eigen::Index i = 0; i < count; ++i) {
      saved.ids.push_back(corner_id(static_cast<int>(i)));
      saved.observations.push_back(1);
      saved.landmarks.segment<3>(3 * i) = points[static_cast<std::size_t>(i)];
    }
    saved.covariance = sigma_m * sigma_m * Eigen::MatrixXd::Identity(3 + 3 * count, 3 + 3 * count);
    EXPECT_TRUE(map.load(saved));
  }

  /// A ray to a point from where the robot is believed to be, with sigma of its inverse depth. Its index.
  int add_ray(int number, const Eigen::Vector3d& p_world, double rho_sigma) {
    const int anchor = *map.map().add_anchor();
    const Eigen::Vector3d p_camera = in_camera(p_world);
    const int feature =
        map.add_ray(corner_id(number), anchor,
                    {p_camera.x() / p_camera.z(), p_camera.y() / p_camera.z(), 1.0 / p_camera.z()},
                    ekf::ray_covariance(1e-6 * Eigen::Matrix2d::Identity(), rho_sigma), 1);
    map.map().release(anchor);
    return feature;
  }

  [[nodiscard]] CameraPose here() const { return prediction.camera_pose(map.map()); }
  [[nodiscard]] Eigen::Vector3d in_camera(const Eigen::Vector3d& p_world) const {
    const CameraPose camera = prediction.camera().pose(truth);
    return camera.R_camera_world * (p_world - camera.p_world_camera);
  }
  /// Where a point, which must be in front of the camera, is in the image.
  [[nodiscard]] Eigen::Vector2d pixel(const Eigen::Vector3d& p_world) const {
    return prediction.camera().project(in_camera(p_world))->pixel;
  }
  /// A perfect pixel of a landmark of the map that stands at a point.
  [[nodiscard]] ekf::FoundPixel find(int feature, const Eigen::Vector3d& p_world,
                                     double sigma_px = 0.3) const {
    return {feature, pixel(p_world), sigma_px * sigma_px * Eigen::Matrix2d::Identity()};
  }

  ekf::PixelPrediction prediction;
  ekf::BoundedMap map;
  Pose2 truth;
};

/// Points on a wall 4 m ahead, in view from the origin.
inline std::vector<Eigen::Vector3d> wall(int count) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i)
    points.emplace_back(4.0, -1.6 + 3.2 * i / std::max(1, count - 1), 0.2 + 0.15 * (i % 6));
  return points;
}

}  // namespace waymark::test
