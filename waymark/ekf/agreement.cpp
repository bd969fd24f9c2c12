#include "waymark/ekf/agreement.hpp"

#include <utility>

#include <Eigen/LU>

#include "waymark/core/gaussian.hpp"

namespace waymark::ekf {
namespace {

/// S_ij from the lower triangle.
Eigen::Matrix2d block(const Agreement::JointCovariance& S, std::size_t i, std::size_t j) {
  const auto at = [](std::size_t k) { return static_cast<Eigen::Index>(2 * k); };
  if (i > j) return S.block<2, 2>(at(i), at(j));
  if (i < j) return S.block<2, 2>(at(j), at(i)).transpose();
  const Eigen::Matrix2d own = S.block<2, 2>(at(i), at(i));
  return own.selfadjointView<Eigen::Lower>();
}

}  // namespace

Agreement::Score Agreement::try_with(std::size_t i, const JointCovariance& S,
                                     std::span<const Eigen::Vector2d> nu, double gate) {
  const Eigen::Matrix2d S_ii = block(S, i, i);
  const auto own = mahalanobis_squared<2>(nu[i], S_ii);
  if (!own || *own > gate) return {};
  const Eigen::Matrix2d S_ii_inverse = S_ii.inverse();
  Score score{1, *own};
  for (std::size_t j = 0; j < nu.size(); ++j) {
    tried_[j] = j == i ? 1 : 0;
    if (j == i) continue;
    const Eigen::Matrix2d S_ji = block(S, j, i);
    const Eigen::Matrix2d A = S_ji * S_ii_inverse;
    const auto d2 = mahalanobis_squared<2>(nu[j] - A * nu[i], block(S, j, j) - A * S_ji.transpose());
    if (!d2 || *d2 > gate) continue;
    tried_[j] = 1;
    ++score.count;
    score.residual2 += *d2;
  }
  return score;
}

std::span<const char> Agreement::largest(const JointCovariance& S, std::span<const Eigen::Vector2d> nu,
                                         double gate) {
  largest_.assign(nu.size(), 0);
  tried_.resize(nu.size());
  Score best;
  for (std::size_t i = 0; i < nu.size(); ++i) {
    const Score score = try_with(i, S, nu, gate);
    if (!score.beats(best)) continue;
    best = score;
    std::swap(largest_, tried_);
    tried_.resize(nu.size());
  }
  return largest_;
}

}  // namespace waymark::ekf
