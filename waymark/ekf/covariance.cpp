#include "waymark/ekf/covariance.hpp"

#include <cassert>
#include <utility>

#include "waymark/kernels/layout.hpp"
#include "waymark/kernels/move_block.hpp"
#include "waymark/kernels/symmetric_rows.hpp"

namespace waymark::ekf {

static_assert(SparseJacobian::kMaxRows <= kernels::kMaxRows);

Covariance::Covariance(std::size_t size, std::size_t capacity)
    : n_(size), ld_(kernels::padded_stride(capacity)), P_(ld_ * ld_), derived_(3 * ld_) {}

void Covariance::defer_to_robot_rows(const Eigen::Vector2d& phi) {
  deferred_phi_ += phi;
  deferred_ = true;
}

Eigen::Vector2d Covariance::propagate_cross_covariance() {
  if (!deferred_) return Eigen::Vector2d::Zero();
  double* row_x = row(0);
  double* row_y = row(1);
  const double* row_theta = row(2);
  for (std::size_t j = 3; j < n_; ++j) {  // Vincke (6)
    row_x[j] += deferred_phi_.x() * row_theta[j];
    row_y[j] += deferred_phi_.y() * row_theta[j];
  }
  deferred_ = false;
  return std::exchange(deferred_phi_, Eigen::Vector2d::Zero());
}

void Covariance::project(const SparseJacobian& J, double* out, std::size_t ld) const {
  assert(!deferred_);
  kernels::project_rows(P_.data(), ld_, n_, J.rows.data(), J.size(), J.J.data(),
                        static_cast<std::size_t>(J.J.rows()), out, ld);
}

NewRows Covariance::derive(const SparseJacobian& J, const Eigen::Matrix3d& noise) {
  project(J, derived_.data(), ld_);
  const auto count = static_cast<int>(J.J.rows());
  NewRows derived{count, derived_.data(), ld_, noise};
  for (int a = 0; a < count; ++a)
    for (int b = 0; b < count; ++b)
      for (int k = 0; k < J.J.cols(); ++k)
        derived.covariance(a, b) +=
            derived_[static_cast<std::size_t>(a) * ld_ + J.rows[static_cast<std::size_t>(k)]] * J.J(b, k);
  return derived;
}

void Covariance::append(const NewRows& rows) {
  assert(!deferred_);
  const std::size_t at = std::exchange(n_, n_ + static_cast<std::size_t>(rows.count));
  write(at, at, rows);
}

void Covariance::replace(std::size_t at, const NewRows& rows) {
  assert(!deferred_);
  write(at, n_, rows);
}

/// Into rows and columns `at`, ...: what they have in common with the first n values, then with themselves.
void Covariance::write(std::size_t at, std::size_t n, const NewRows& rows) {
  const auto count = static_cast<std::size_t>(rows.count);
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t j = 0; j < n; ++j)
      row(std::min(at + a, j))[std::max(at + a, j)] = rows.cross[a * rows.ld + j];
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = a; b < count; ++b)
      row(at + a)[at + b] = rows.covariance(static_cast<int>(a), static_cast<int>(b));
}

void Covariance::remove(std::size_t at, std::size_t count) {
  assert(!deferred_);
  const std::size_t from = n_ - count;
  if (at != from) kernels::move_block(P_.data(), ld_, n_, from, at, count);
  n_ = from;
}

}  // namespace waymark::ekf
