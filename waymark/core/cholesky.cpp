#include "waymark/core/cholesky.hpp"

namespace waymark {

Cholesky::Cholesky(const Eigen::MatrixXd& S) : llt_(S) {}

double Cholesky::log_determinant() const {
  return 2.0 * Eigen::MatrixXd(llt_.matrixL()).diagonal().array().log().sum();
}

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& B) const { return llt_.solve(B); }
Eigen::VectorXd Cholesky::solve(const Eigen::VectorXd& b) const { return llt_.solve(b); }
Eigen::MatrixXd Cholesky::whiten(const Eigen::MatrixXd& B) const { return llt_.matrixL().solve(B); }
Eigen::VectorXd Cholesky::whiten(const Eigen::VectorXd& b) const { return llt_.matrixL().solve(b); }

}  // namespace waymark
