#pragma once

#include <optional>

#include <Eigen/Sparse>

namespace waymark::smooth {

using SparseMatrix = Eigen::SparseMatrix<double>;
using SparseCholesky = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>>;

/// Entries of the inverse of a sparse symmetric matrix wherever its Cholesky factor has entries, which are
/// all that its own pattern has: marginal covariances from an information matrix (Takahashi et al. 1973;
/// Kaess and Dellaert 2009).
class SelectedInverse {
 public:
  /// Nothing if that takes more than `max_work` multiplications: sum over columns of the square of their
  /// entries.
  [[nodiscard]] static std::optional<SelectedInverse> compute(const SparseCholesky& factor, double max_work);

  /// An entry within the pattern.
  [[nodiscard]] double operator()(Eigen::Index row, Eigen::Index column) const;

 private:
  explicit SelectedInverse(const SparseCholesky& factor);
  void fill_column(Eigen::Index column);

  SparseMatrix Z_;            // lower triangle with its diagonal, permuted as the factor
  Eigen::VectorXd D_;         // of L D L^T
  SparseMatrix L_;            // strictly lower triangle
  Eigen::VectorXi permuted_;  // of each row of the matrix
  Eigen::VectorXd scratch_;   // by permuted row
};

}  // namespace waymark::smooth
