#pragma once

#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace waymark::eval {

/// Normalised estimation error squared e^T P^-1 e (Bar-Shalom, Li, Kirubarajan 2001): chi-square with N
/// degrees of freedom when P is honest. Nothing where P says that some direction is known exactly (a robot
/// that has not moved yet, the sideways direction after one step of a wheeled robot): a standard deviation
/// below 1e-6, or correlations that leave less than 1e-9 of a variance.
template <int N>
[[nodiscard]] std::optional<double> nees(const Eigen::Matrix<double, N, 1>& error,
                                         const Eigen::Matrix<double, N, N>& P) {
  using Vector = Eigen::Matrix<double, N, 1>;
  constexpr double kMinSigma = 1e-6;
  constexpr double kMinShare = 1e-9;
  const Vector sigma = P.diagonal().cwiseSqrt();
  if (!(sigma.array() >= kMinSigma).all()) return std::nullopt;
  const Vector scale = sigma.cwiseInverse();
  const Eigen::Matrix<double, N, N> correlation = scale.asDiagonal() * P * scale.asDiagonal();
  const Eigen::LLT<Eigen::Matrix<double, N, N>> llt(correlation);
  if (llt.info() != Eigen::Success) return std::nullopt;
  if (!(llt.matrixLLT().diagonal().array().square() > kMinShare).all()) return std::nullopt;
  const Vector scaled = scale.cwiseProduct(error);
  return llt.matrixL().solve(scaled).squaredNorm();
}

}  // namespace waymark::eval
