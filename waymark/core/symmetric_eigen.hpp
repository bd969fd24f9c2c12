#pragma once

#include "waymark/core/solve_symmetric.hpp"

namespace waymark {

/// Eigenvalues of a symmetric matrix in ascending order, and eigenvectors of length 1 as columns.
struct SymmetricEigen {
  Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 9, 1> values;
  SmallMatrix vectors;
};
[[nodiscard]] SymmetricEigen symmetric_eigen(const SmallMatrix& A);

}  // namespace waymark
