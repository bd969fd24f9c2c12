#include "waymark/core/cholesky.hpp"

namespace waymark {

Cholesky::Cholesky(const Eigen::MatrixXd& S) : llt_(S) {}

/// Eigen takes a pivot that is not a number for a positive one.
bool Cholesky::is_positive_definite() const {
  return llt_.info() == Eigen::Success && (llt_.matrixLLT().diagonal().array() > 0.0).all();
}

double Cholesky::log_determinant() const {
  return 2.0 * Eigen::MatrixXd(llt_.matrixL()).diagonal().array().log().sum();
}

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& B) const { return llt_.solve(B); }
Eigen::VectorXd Cholesky::solve(const Eigen::VectorXd& b) const { return llt_.solve(b); }
Eigen::MatrixXd Cholesky::whiten(const Eigen::MatrixXd& B) const { return llt_.matrixL().solve(B); }
Eigen::VectorXd Cholesky::whiten(const Eigen::VectorXd& b) const { return llt_.matrixL().solve(b); }

}  // namespace waymark
