#pragma once

#include <Eigen/Core>

namespace waymark {

/// Eigenvalues of a symmetric matrix in ascending order, and their directions, of length 1, as columns.
struct PrincipalAxes {
  Eigen::Vector2d variances;
  Eigen::Matrix2d directions;
};

/// In closed form. Eigenvalues are as exact as the largest of them.
[[nodiscard]] PrincipalAxes principal_axes(const Eigen::Matrix2d& covariance);

}  // namespace waymark
