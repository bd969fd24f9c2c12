#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace waymark {

/// S = L L^T of a symmetric matrix of any size. Compiled once: where Eigen's own is asked for, it is compiled
/// anew.
class Cholesky {
 public:
  explicit Cholesky(const Eigen::MatrixXd& S);

  /// Whether S is positive definite; otherwise nothing else here means anything.
  [[nodiscard]] bool is_positive_definite() const;
  /// log |S|
  [[nodiscard]] double log_determinant() const;

  /// S^-1 B
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  /// L^-1 B: rows with covariance S become rows of standard deviation 1 that do not depend on each other.
  [[nodiscard]] Eigen::MatrixXd whiten(const Eigen::MatrixXd& B) const;
  [[nodiscard]] Eigen::VectorXd whiten(const Eigen::VectorXd& b) const;

 private:
  Eigen::LLT<Eigen::MatrixXd> llt_;
};

}  // namespace waymark
