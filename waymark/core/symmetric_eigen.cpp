#include "waymark/core/symmetric_eigen.hpp"

#include <Eigen/Eigenvalues>

namespace waymark {

SymmetricEigen symmetric_eigen(const SmallMatrix& A) {
  const Eigen::SelfAdjointEigenSolver<SmallMatrix> eigen(A);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

}  // namespace waymark
