#pragma once

#include <Eigen/Core>

namespace waymark {

/// At most nine rows and columns, held in place.
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 9, 9>;

/// A^-1 B of a symmetric A, positive or negative semi-definite, by L D L^T with pivoting; the inverse where B
/// is the identity. One function for all sizes: for each size of its own, Eigen's takes the compiler seconds.
[[nodiscard]] SmallMatrix solve_symmetric(const SmallMatrix& A, const SmallMatrix& B);

}  // namespace waymark
