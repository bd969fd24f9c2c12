#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "waymark/kernels/particle_columns.hpp"

namespace waymark::fastslam {

/// One landmark as one particle sees it: mean and covariance given that particle's path, m.
struct PointGaussian {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

/// Where entry `place` of a landmark says that it is: mean and covariance of (x, y), from the view's origin.
/// Rays and rings by Gauss and Hermite's quadrature of three points per number, several hypotheses by their
/// moments.
[[nodiscard]] PointGaussian point_of(const kernels::LandmarkView& landmark, std::size_t place);

}  // namespace waymark::fastslam
