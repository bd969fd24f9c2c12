#include "waymark/ekf/compressed_terms.hpp"

#include <algorithm>

#include "waymark/kernels/add_scaled_rows.hpp"
#include "waymark/kernels/layout.hpp"
#include "waymark/kernels/symmetric_update.hpp"
#include "waymark/kernels/triangular_solve.hpp"

namespace waymark::ekf {
namespace {

using Strided = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>,
                           Eigen::Aligned64, Eigen::OuterStride<>>;

Strided matrix(const AlignedArray<double>& buffer, std::size_t n, std::size_t ld) {
  const auto size = static_cast<Eigen::Index>(n);
  return {buffer.data(), size, size, Eigen::OuterStride<>(static_cast<Eigen::Index>(ld))};
}

}  // namespace

CompressedTerms::CompressedTerms(std::size_t capacity)
    : ld_(kernels::padded_stride(capacity)),
      phi_(ld_ * ld_),
      minus_psi_(ld_ * ld_),
      tau_(ld_),
      G_((Update::kMaxRows + 1) * ld_) {}

void CompressedTerms::restart(std::size_t n) {
  n_ = 0;
  turn_ = 0.0;
  grow(n);
  for (std::size_t i = 0; i < n; ++i) phi_[i * ld_ + i] = 1.0;
}

void CompressedTerms::grow(std::size_t dimension) {
  const std::size_t grown = n_ + dimension;
  for (std::size_t i = 0; i < grown; ++i) {
    const std::size_t from = i < n_ ? n_ : 0;
    std::fill(&phi_[i * ld_ + from], &phi_[i * ld_] + grown, 0.0);
    std::fill(&minus_psi_[i * ld_ + from], &minus_psi_[i * ld_] + grown, 0.0);
  }
  std::fill(&tau_[n_], tau_.data() + grown, 0.0);
  n_ = grown;
}

void CompressedTerms::carry(const Eigen::Vector2d& displacement) {
  const double* heading = &phi_[2 * ld_];
  for (std::size_t j = 0; j < n_; ++j) {
    phi_[j] += displacement.x() * heading[j];
    phi_[ld_ + j] += displacement.y() * heading[j];
  }
}

void CompressedTerms::propagate_bias(int pair, double rho) {
  double* rows = &phi_[bias_offset(pair) * ld_];
  for (std::size_t j = 0; j < n_; ++j) {
    rows[j] *= rho;
    rows[ld_ + j] *= rho;
  }
}

/// out += row `row` of J phi(rows, :), run by run of neighbouring rows.
void CompressedTerms::add_rows(double* out, const SparseJacobian& jacobian, int row) const {
  for (std::size_t k = 0; k < jacobian.size();) {
    std::size_t end = k + 1;
    while (end < jacobian.size() && jacobian.rows[end] == jacobian.rows[end - 1] + 1) ++end;
    kernels::add_scaled_rows(out, &phi_[jacobian.rows[k] * ld_], ld_, end - k,
                             &jacobian.J(row, static_cast<Eigen::Index>(k)), n_);
    k = end;
  }
}

void CompressedTerms::project(std::span<const LinearizedObservation> linearizations,
                              const StateLayout& layout) {
  double* g = G_.data();
  for (const LinearizedObservation& linearization : linearizations) {
    const SparseJacobian jacobian = layout.jacobian(linearization, linearization.rows);
    for (int r = 0; r < linearization.rows; ++r, g += ld_) {
      std::fill_n(g, n_, 0.0);
      add_rows(g, jacobian, r);
    }
  }
}

void CompressedTerms::absorb(const Gain& gain) {
  const kernels::RowBand all{0, n_};
  kernels::triangular_solve(gain.L, gain.ld_l, gain.rows, G_.data(), ld_, n_);
  kernels::symmetric_downdate(minus_psi_.data(), ld_, n_, G_.data(), ld_, gain.rows, all);
  kernels::add_scaled_rows(tau_.data(), G_.data(), ld_, gain.rows, gain.nu, n_);
  kernels::subtract_product(phi_.data(), ld_, n_, gain.W, gain.ld, G_.data(), ld_, gain.rows, all);
  if (gain.shear != nullptr) shear_phi(gain);
}

/// phi <- (I + d e_theta^T) phi
void CompressedTerms::shear_phi(const Gain& gain) {
  double* minus_heading = &G_[gain.rows * ld_];
  std::transform(&phi_[2 * ld_], &phi_[2 * ld_] + n_, minus_heading, std::negate<>());
  kernels::subtract_product(phi_.data(), ld_, n_, gain.shear, gain.ld, minus_heading, ld_, 1, {0, n_});
  turn_ += gain.turn;
}

void CompressedTerms::append_new(int dimension, const Eigen::Matrix3d& G_pose, const BiasTerms& errors) {
  const std::size_t first = n_;
  const SparseJacobian jacobian(G_pose.topRows(dimension), errors);
  grow(static_cast<std::size_t>(dimension));
  for (int a = 0; a < dimension; ++a)
    add_rows(&phi_[(first + static_cast<std::size_t>(a)) * ld_], jacobian, a);
}

void CompressedTerms::append_known(const Eigen::Ref<const Eigen::MatrixXd>& B, const Eigen::Vector3d& d) {
  const std::size_t first = n_;
  grow(static_cast<std::size_t>(B.cols()));
  const Eigen::Map<const Eigen::VectorXd> heading(&phi_[2 * ld_], B.rows());
  for (int a = 0; a < B.cols(); ++a) {
    double* row = &phi_[(first + static_cast<std::size_t>(a)) * ld_];
    Eigen::Map<Eigen::VectorXd> known(row, B.rows());
    known.noalias() = matrix(minus_psi_, first, ld_).selfadjointView<Eigen::Upper>() * B.col(a);
    known += d[a] * heading;
    row[first + static_cast<std::size_t>(a)] = 1.0;
  }
}

void CompressedTerms::multiply_phi(const ConstColumn& b, Column out) const {
  out.noalias() = matrix(phi_, n_, ld_) * b;
}

void CompressedTerms::multiply_minus_psi(const ConstColumn& b, Column out) const {
  out.noalias() = matrix(minus_psi_, n_, ld_).selfadjointView<Eigen::Upper>() * b;
}

}  // namespace waymark::ekf
