#include "waymark/core/gaussian.hpp"

#include <Eigen/Eigenvalues>

namespace waymark {

bool is_covariance(const Eigen::Ref<const Eigen::MatrixXd>& P) {
  if (P.rows() != P.cols() || !P.allFinite()) return false;
  const double scale = P.cwiseAbs().maxCoeff();
  if (scale == 0.0) return true;
  if ((P - P.transpose()).cwiseAbs().maxCoeff() > 1e-9 * scale) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(P, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().minCoeff() >= -1e-9 * scale;
}

}  // namespace waymark
