#pragma once

#include <algorithm>
#include <cstddef>

#include <Eigen/Core>

#include "waymark/core/aligned_array.hpp"
#include "waymark/ekf/sparse_jacobian.hpp"

namespace waymark::ekf {

/// Values y that are to become part of a state of n values x, as its covariance sees them. A view.
struct NewRows {
  int count;                   ///< of values: up to 3
  const double* cross;         ///< count x n: cov(y, x)
  std::size_t ld;              ///< stride of cross
  Eigen::Matrix3d covariance;  ///< of y: the leading count x count part
};

/// The covariance P of a state of n values, the first three of which are the robot's (x, y, theta). Only the
/// upper triangle is kept (kernels/layout.hpp), in memory that is taken once.
///
/// A motion of the robot changes P_rr at once, but P_rm, what the robot has in common with everything else,
/// is only due Phi = [I, phi; 0, 1], which propagate_cross_covariance() makes up for: once per update, not
/// once per motion. What is asked for in between is answered as if that were done.
class Covariance {
 public:
  /// Zeros; never more than `capacity` values.
  Covariance(std::size_t size, std::size_t capacity);

  [[nodiscard]] std::size_t size() const { return n_; }
  [[nodiscard]] double operator()(std::size_t i, std::size_t j) const {
    const auto [row, column] = std::minmax(i, j);
    const double p = P_[row * ld_ + column];
    return deferred_ && row < 2 && column >= 3
               ? p + deferred_phi_[static_cast<int>(row)] * P_[2 * ld_ + column]
               : p;
  }
  /// cov of the N values from `i` on with those from `j` on.
  template <int N>
  [[nodiscard]] Eigen::Matrix<double, N, N> block(std::size_t i, std::size_t j) const;
  template <int N>
  [[nodiscard]] Eigen::Matrix<double, N, N> block(std::size_t i) const {
    return block<N>(i, i);
  }

  /// The motion of the robot that P_rm is due: phi as in Phi.
  void defer_to_robot_rows(const Eigen::Vector2d& phi);
  [[nodiscard]] const Eigen::Vector2d& deferred() const { return deferred_phi_; }
  /// P_rm <- Phi P_rm. Returns phi: zero if nothing was due. O(n).
  Eigen::Vector2d propagate_cross_covariance();

  // From here on nothing may be due.

  /// out = J P, as many rows as J has, `ld` apart. O(n).
  void project(const SparseJacobian& J, double* out, std::size_t ld) const;
  /// y = J x + v, with v of covariance `noise` and independent of x. The view is good until the next call.
  /// O(n).
  [[nodiscard]] NewRows derive(const SparseJacobian& J, const Eigen::Matrix3d& noise);
  void append(const NewRows& rows);
  /// y takes the place of the values from `at` on.
  void replace(std::size_t at, const NewRows& rows);
  /// The last `count` values take the place of those from `at` on, which are marginalised out. O(n).
  void remove(std::size_t at, std::size_t count);

  /// Rows i and columns j >= i as they are kept, for those who compute with whole rows.
  [[nodiscard]] double* data() { return P_.data(); }
  [[nodiscard]] const double* data() const { return P_.data(); }
  [[nodiscard]] std::size_t stride() const { return ld_; }
  [[nodiscard]] double* row(std::size_t i) { return P_.data() + i * ld_; }
  /// What is beyond the old size has no meaning yet.
  void resize(std::size_t n) { n_ = n; }

 private:
  void write(std::size_t at, std::size_t n, const NewRows& rows);

  std::size_t n_;
  std::size_t ld_;
  AlignedArray<double> P_;
  AlignedArray<double> derived_;  // 3 x n: J P of derive()
  bool deferred_ = false;
  Eigen::Vector2d deferred_phi_ = Eigen::Vector2d::Zero();
};

template <int N>
Eigen::Matrix<double, N, N> Covariance::block(std::size_t i, std::size_t j) const {
  Eigen::Matrix<double, N, N> part;
  for (int a = 0; a < N; ++a)
    for (int b = 0; b < N; ++b)
      part(a, b) = (*this)(i + static_cast<std::size_t>(a), j + static_cast<std::size_t>(b));
  return part;
}

}  // namespace waymark::ekf
