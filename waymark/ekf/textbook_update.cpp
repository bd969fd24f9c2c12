#include "waymark/ekf/textbook_update.hpp"

#include <cmath>
#include <utility>

namespace waymark::ekf {
namespace {

/// C = A B
void multiply(const DenseMatrix& A, const DenseMatrix& B, DenseMatrix& C) {
  C.reset(A.rows(), B.columns());
  for (std::size_t i = 0; i < A.rows(); ++i) {
    for (std::size_t j = 0; j < B.columns(); ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < A.columns(); ++k) sum += A(i, k) * B(k, j);
      C(i, j) = sum;
    }
  }
}

/// C = A B^T
void multiply_transposed(const DenseMatrix& A, const DenseMatrix& B, DenseMatrix& C) {
  C.reset(A.rows(), B.rows());
  for (std::size_t i = 0; i < A.rows(); ++i) {
    for (std::size_t j = 0; j < B.rows(); ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < A.columns(); ++k) sum += A(i, k) * B(j, k);
      C(i, j) = sum;
    }
  }
}

}  // namespace

TextbookUpdate::TextbookUpdate(std::size_t max_rows, std::size_t largest_state)
    : H(max_rows, largest_state),
      R(max_rows, max_rows),
      P(largest_state, largest_state),
      nu(max_rows, 1),
      dx(largest_state, 1),
      PHt_(largest_state, max_rows),
      S_(max_rows, max_rows),
      S_inverse_(max_rows, max_rows),
      K_(largest_state, max_rows),
      I_KH_(largest_state, largest_state),
      P_new_(largest_state, largest_state) {}

bool TextbookUpdate::propose(const Covariance& covariance, const StateLayout& layout,
                             std::span<const LinearizedObservation> linearizations, double* increments) {
  write_down(covariance, layout, linearizations);
  if (!solve()) return false;
  for (std::size_t i = 0; i < covariance.size(); ++i) increments[i] = dx(i, 0);
  return true;
}

void TextbookUpdate::correct(Covariance& covariance) {
  correct();
  for (std::size_t i = 0; i < covariance.size(); ++i)
    for (std::size_t j = i; j < covariance.size(); ++j) covariance.row(i)[j] = P(i, j);
}

/// H, R, nu and P as dense matrices.
void TextbookUpdate::write_down(const Covariance& covariance, const StateLayout& layout,
                                std::span<const LinearizedObservation> linearizations) {
  std::size_t D = 0;
  for (const LinearizedObservation& linearization : linearizations)
    D += static_cast<std::size_t>(linearization.rows);
  begin(D, covariance.size());
  std::size_t row = 0;
  for (const LinearizedObservation& linearization : linearizations) {
    const SparseJacobian t = layout.jacobian(linearization, linearization.rows);
    for (int r = 0; r < linearization.rows; ++r, ++row) {
      for (int k = 0; k < t.J.cols(); ++k) H(row, t.rows[static_cast<std::size_t>(k)]) = t.J(r, k);
      for (int s = 0; s < linearization.rows; ++s)
        R(row, row + static_cast<std::size_t>(s) - static_cast<std::size_t>(r)) = linearization.R(r, s);
      nu(row, 0) = linearization.nu[r];
    }
  }
  for (std::size_t i = 0; i < covariance.size(); ++i)
    for (std::size_t j = 0; j < covariance.size(); ++j) P(i, j) = covariance(i, j);
}

void TextbookUpdate::begin(std::size_t rows, std::size_t size) {
  H.reset(rows, size);
  R.reset(rows, rows);
  P.reset(size, size);
  nu.reset(rows, 1);
}

bool TextbookUpdate::solve() {
  multiply_transposed(P, H, PHt_);
  multiply(H, PHt_, S_);
  for (std::size_t i = 0; i < S_.rows(); ++i)
    for (std::size_t j = 0; j < S_.rows(); ++j) S_(i, j) += R(i, j);  // Vincke (11)
  if (!invert_innovation_covariance()) return false;
  multiply(PHt_, S_inverse_, K_);  // Vincke (12)
  multiply(K_, nu, dx);            // Vincke (12)
  return true;
}

/// By Gauss and Jordan; the pivots of a positive definite matrix are positive without a search for them.
bool TextbookUpdate::invert_innovation_covariance() {
  const std::size_t D = S_.rows();
  S_inverse_.reset(D, D);
  for (std::size_t i = 0; i < D; ++i) S_inverse_(i, i) = 1.0;
  for (std::size_t pivot = 0; pivot < D; ++pivot) {
    const double p = S_(pivot, pivot);
    if (!(p > 0.0) || !std::isfinite(p)) return false;
    for (std::size_t j = 0; j < D; ++j) {
      S_(pivot, j) /= p;
      S_inverse_(pivot, j) /= p;
    }
    for (std::size_t i = 0; i < D; ++i) {
      if (i == pivot) continue;
      const double factor = S_(i, pivot);
      for (std::size_t j = 0; j < D; ++j) {
        S_(i, j) -= factor * S_(pivot, j);
        S_inverse_(i, j) -= factor * S_inverse_(pivot, j);
      }
    }
  }
  return true;
}

void TextbookUpdate::correct() {
  multiply(K_, H, I_KH_);
  for (std::size_t i = 0; i < I_KH_.rows(); ++i)
    for (std::size_t j = 0; j < I_KH_.rows(); ++j) I_KH_(i, j) = (i == j ? 1.0 : 0.0) - I_KH_(i, j);
  multiply(I_KH_, P, P_new_);  // Vincke (12)
  std::swap(P, P_new_);
}

}  // namespace waymark::ekf
