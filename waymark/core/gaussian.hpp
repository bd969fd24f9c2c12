#pragma once

#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace waymark {

/// log(2 pi): the constant in the logarithm of a Gaussian's density, halved per dimension.
inline constexpr double kLogTwoPi = 1.8378770664093453;

/// Finite, symmetric to 1e-9 of its largest entry, and no eigenvalue below -1e-9 of the largest one.
/// O(n^3): for inputs and tests, not for the hot loop.
[[nodiscard]] bool is_covariance(const Eigen::Ref<const Eigen::MatrixXd>& P);

/// nu^T S^-1 nu by Cholesky, or nothing when S is not positive definite or anything is not finite.
template <int N>
[[nodiscard]] std::optional<double> mahalanobis_squared(const Eigen::Matrix<double, N, 1>& nu,
                                                        const Eigen::Matrix<double, N, N>& S) {
  const Eigen::LLT<Eigen::Matrix<double, N, N>> llt(S);
  if (llt.info() != Eigen::Success || !S.allFinite()) return std::nullopt;
  const double d2 = nu.dot(llt.solve(nu));
  return d2 >= 0.0 && d2 < 1e300 ? std::optional(d2) : std::nullopt;
}

/// log N(nu; 0, S) where d2 is the mahalanobis_squared() of nu. S is positive definite.
template <int N>
[[nodiscard]] double log_gaussian(double d2, const Eigen::Matrix<double, N, N>& S) {
  const Eigen::Matrix<double, N, N> L = S.llt().matrixL();
  return -0.5 * (d2 + N * kLogTwoPi) - L.diagonal().array().log().sum();
}

/// A mean with its covariance, N-dimensional.
template <int N>
struct Gaussian {
  Eigen::Matrix<double, N, 1> mean = Eigen::Matrix<double, N, 1>::Zero();
  Eigen::Matrix<double, N, N> covariance = Eigen::Matrix<double, N, N>::Zero();

  [[nodiscard]] bool is_valid() const { return mean.allFinite() && is_covariance(covariance); }
};

}  // namespace waymark
