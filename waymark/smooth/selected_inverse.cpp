#include "waymark/smooth/selected_inverse.hpp"

#include <algorithm>

namespace waymark::smooth {

std::optional<SelectedInverse> SelectedInverse::compute(const SparseCholesky& factor, double max_work) {
  SelectedInverse inverse(factor);
  double work = 0.0;
  for (Eigen::Index column = 0; column < inverse.Z_.cols(); ++column) {
    const auto entries = static_cast<double>(inverse.Z_.col(column).nonZeros());
    work += entries * entries;
  }
  if (work > max_work) return std::nullopt;
  for (Eigen::Index column = inverse.Z_.cols() - 1; column >= 0; --column) inverse.fill_column(column);
  return inverse;
}

SelectedInverse::SelectedInverse(const SparseCholesky& factor)
    : D_(factor.vectorD()), permuted_(factor.permutationP().indices()) {
  Z_ = factor.matrixL();  // with its unit diagonal
  L_ = Z_.triangularView<Eigen::StrictlyLower>();
  scratch_ = Eigen::VectorXd::Zero(Z_.cols());
}

/// Z_jj = 1 / d_j - sum_k L_kj Z_kj and Z_ij = - sum_k L_kj Z_ik over the entries k of column j, from columns
/// behind it alone.
void SelectedInverse::fill_column(Eigen::Index column) {
  for (SparseMatrix::InnerIterator k(L_, column); k; ++k) scratch_[k.row()] = 0.0;
  // Each column of Z behind this one serves as itself below its diagonal and as a row right of it.
  for (SparseMatrix::InnerIterator k(L_, column); k; ++k) {
    SparseMatrix::InnerIterator z(Z_, k.row());
    SparseMatrix::InnerIterator i = k;
    for (; i && z;) {
      if (z.row() < i.row()) {
        ++z;
      } else if (z.row() > i.row()) {
        ++i;
      } else {
        scratch_[i.row()] -= k.value() * z.value();
        if (i.row() != k.row()) scratch_[k.row()] -= i.value() * z.value();
        ++i, ++z;
      }
    }
  }
  double diagonal = 1.0 / D_[column];
  for (SparseMatrix::InnerIterator k(L_, column); k; ++k) diagonal -= k.value() * scratch_[k.row()];
  for (SparseMatrix::InnerIterator z(Z_, column); z; ++z)
    z.valueRef() = z.row() == column ? diagonal : scratch_[z.row()];
}

double SelectedInverse::operator()(Eigen::Index row, Eigen::Index column) const {
  const int a = permuted_[row];
  const int b = permuted_[column];
  return Z_.coeff(std::max(a, b), std::min(a, b));
}

}  // namespace waymark::smooth
