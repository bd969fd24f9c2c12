#include "waymark/core/gaussian.hpp"

#include <Eigen/Cholesky>

namespace waymark {

bool is_covariance(const Eigen::Ref<const Eigen::MatrixXd>& P) {
  if (P.size() == 0) return true;
  if (P.rows() != P.cols() || !P.allFinite()) return false;
  const double scale = P.cwiseAbs().maxCoeff();
  if (scale == 0.0) return true;
  if ((P - P.transpose()).cwiseAbs().maxCoeff() > 1e-9 * scale) return false;
  Eigen::MatrixXd lifted = P;
  lifted.diagonal().array() += 1e-9 * scale;
  return Eigen::LLT<Eigen::MatrixXd>(lifted).info() == Eigen::Success;
}

}  // namespace waymark
