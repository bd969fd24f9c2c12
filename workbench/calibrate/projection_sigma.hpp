#pragma once

#include <vector>

#include <Eigen/Core>

#include "workbench/calibrate/camera_fit.hpp"

namespace waymark::calibrate {

/// How well a fitted camera knows where it looks, at one place of the image.
struct ProjectionSigma {
  Eigen::Vector2d pixel;
  double sigma_px = 0.0;  ///< along the direction that is known worst
};

inline constexpr int kProjectionColumns = 16;
inline constexpr int kProjectionRows = 12;

/// On a grid over the image, row by row: how far off the image of a far point may be when the errors of the
/// intrinsics go through the lens, less what turning the camera makes good (a principal point that is off and
/// a camera that is turned look alike, and a pose takes up the latter). `covariance` is that of the
/// intrinsics.
[[nodiscard]] std::vector<ProjectionSigma> projection_sigmas(const CameraOptions& camera,
                                                             const IntrinsicsCovariance& covariance,
                                                             int columns = kProjectionColumns,
                                                             int rows = kProjectionRows);

}  // namespace waymark::calibrate
