#include "workbench/calibrate/projection_sigma.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "waymark/core/principal_axes.hpp"
#include "waymark/core/solve_symmetric.hpp"

namespace waymark::calibrate {

std::vector<ProjectionSigma> projection_sigmas(const CameraOptions& camera,
                                               const IntrinsicsCovariance& covariance, int columns,
                                               int rows) {
  using PixelToIntrinsics = Eigen::Matrix<double, 2, kIntrinsics>;
  using PixelToTurn = Eigen::Matrix<double, 2, 3>;
  const Camera lens(camera);
  std::vector<ProjectionSigma> places;
  std::vector<PixelToIntrinsics> G;
  std::vector<PixelToTurn> W;
  Eigen::Matrix3d WtW = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, kIntrinsics> WtG = Eigen::Matrix<double, 3, kIntrinsics>::Zero();
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const Eigen::Vector2d pixel((column + 0.5) / columns * camera.width_px - 0.5,
                                  (row + 0.5) / rows * camera.height_px - 0.5);
      const auto ray = lens.ray(pixel);
      const auto image = ray ? lens.project(ray->xy.homogeneous()) : std::nullopt;
      if (!image) continue;
      const Eigen::Vector3d p = ray->xy.homogeneous();
      const Eigen::Matrix3d turn{{0.0, p.z(), -p.y()}, {-p.z(), 0.0, p.x()}, {p.y(), -p.x(), 0.0}};
      places.push_back({.pixel = pixel});
      G.emplace_back(intrinsics_jacobian(lens, p));
      W.emplace_back(image->dpixel_dpoint * turn);
      WtW += W.back().transpose() * W.back();
      WtG += W.back().transpose() * G.back();
    }
  if (places.empty()) return places;
  const Eigen::Matrix<double, 3, kIntrinsics> turn_of = solve_symmetric(WtW, WtG);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const PixelToIntrinsics M = G[i] - W[i] * turn_of;
    const Eigen::Matrix2d P = M * covariance * M.transpose();
    places[i].sigma_px = std::sqrt(std::max(0.0, principal_axes(P).variances[1]));
  }
  return places;
}

}  // namespace waymark::calibrate
