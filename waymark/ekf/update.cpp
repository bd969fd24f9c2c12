#include "waymark/ekf/update.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "waymark/kernels/add_scaled_rows.hpp"
#include "waymark/kernels/layout.hpp"
#include "waymark/kernels/symmetric_update.hpp"
#include "waymark/kernels/triangular_solve.hpp"

namespace waymark::ekf {
namespace {

/// Below this size of the state a second thread costs more than it brings.
constexpr std::size_t kParallelSize = 800;

}  // namespace

Update::Update(std::size_t capacity, int threads)
    : ld_(kernels::padded_stride(capacity)),
      W_(ld_ * kMaxRows),
      dx_(ld_),
      S_(kMaxRows, kMaxRows),
      nu_(kMaxRows),
      thread_pool_(threads) {}

void Update::use_textbook() { textbook_ = std::make_unique<TextbookUpdate>(kMaxRows, ld_); }

bool Update::propose(const Covariance& P, const StateLayout& layout,
                     std::span<const LinearizedObservation> linearizations) {
  if (textbook_) return textbook_->propose(P, layout, linearizations, dx_.data());
  const std::size_t n = P.size();
  form_innovation_covariance(P, layout, linearizations);
  if (!factorize()) return false;
  kernels::triangular_solve(S_.data(), static_cast<std::size_t>(S_.cols()), rows_, W_.data(), ld_, n);
  std::fill_n(dx_.data(), n, 0.0);
  kernels::add_scaled_rows(dx_.data(), W_.data(), ld_, rows_, nu_.data(), updated_rows(n));  // Vincke (12)
  std::fill(&dx_[updated_rows(n)], &dx_[n], 0.0);  // the kernel goes on to the end of its vector
  return true;
}

/// C = H P from the rows of P that H depends on, and the lower triangle of S = C H^T + R.
void Update::form_innovation_covariance(const Covariance& P, const StateLayout& layout,
                                        std::span<const LinearizedObservation> linearizations) {
  assert(linearizations.size() <= kMaxObservations);
  rows_ = 0;
  for (const LinearizedObservation& linearization : linearizations) {
    P.project(layout.jacobian(linearization, linearization.rows), &W_[rows_ * ld_], ld_);
    nu_.segment(static_cast<int>(rows_), linearization.rows) = linearization.nu.head(linearization.rows);
    rows_ += static_cast<std::size_t>(linearization.rows);
  }
  int column = 0;
  for (const LinearizedObservation& linearization : linearizations) {
    const SparseJacobian H = layout.jacobian(linearization, linearization.rows);
    for (int i = column; i < static_cast<int>(rows_); ++i) {
      const double* c = &W_[static_cast<std::size_t>(i) * ld_];
      for (int r = 0; r < linearization.rows; ++r) {
        double s = i < column + linearization.rows ? linearization.R(i - column, r) : 0.0;
        // Vincke (11)
        for (int k = 0; k < H.J.cols(); ++k) s += c[H.rows[static_cast<std::size_t>(k)]] * H.J(r, k);
        S_(i, column + r) = s;
      }
    }
    column += linearization.rows;
  }
}

/// S = L L^T in place, nu <- L^-1 nu. False if S is not positive definite.
bool Update::factorize() {
  for (int j = 0; j < static_cast<int>(rows_); ++j) {
    const double pivot = S_(j, j) - S_.row(j).head(j).squaredNorm();
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    S_(j, j) = std::sqrt(pivot);
    for (int i = j + 1; i < static_cast<int>(rows_); ++i)
      S_(i, j) = (S_(i, j) - S_.row(i).head(j).dot(S_.row(j).head(j))) / S_(j, j);
    nu_[j] = (nu_[j] - S_.row(j).head(j).dot(nu_.head(j))) / S_(j, j);
  }
  return true;
}

void Update::correct(Covariance& P, Shear* shear) {
  if (textbook_) return textbook_->correct(P);
  const std::size_t n = P.size();
  if (updated_rows(n) < n)  // Vincke (12)
    return kernels::symmetric_downdate(P.data(), ld_, n, W_.data(), ld_, rows_, {0, updated_rows(n)});
  if (shear != nullptr) shear->prepare(P, W_.data(), ld_, rows_);
  const int bands = n < kParallelSize ? 1 : thread_pool_.size();
  thread_pool_.run(bands, [&](int band) {  // Vincke (12)
    const auto range =
        kernels::triangle_band(n, static_cast<std::size_t>(band), static_cast<std::size_t>(bands));
    if (shear != nullptr)
      kernels::symmetric_update(P.data(), ld_, n, W_.data(), ld_, rows_, shear->d(), shear->e(), range);
    else
      kernels::symmetric_downdate(P.data(), ld_, n, W_.data(), ld_, rows_, range);
  });
}

Gain Update::gain() const {
  return {rows_, ld_, W_.data(), static_cast<std::size_t>(S_.cols()), S_.data(), nu_.data(), nullptr, dx_[2]};
}

JointCovariance Update::joint_innovation_covariance(const Covariance& P, const StateLayout& layout,
                                                    std::span<const LinearizedObservation> linearizations) {
  form_innovation_covariance(P, layout, linearizations);
  return S_.topLeftCorner(static_cast<int>(rows_), static_cast<int>(rows_));
}

}  // namespace waymark::ekf
