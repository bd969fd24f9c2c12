#include "waymark/ekf/one_point_ransac.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/LU>

#include "waymark/core/gaussian.hpp"

namespace waymark::ekf {
namespace {

/// S_ij from the lower triangle.
Eigen::Matrix2d block(const JointCovariance& S, std::size_t i, std::size_t j) {
  const auto at = [](std::size_t k) { return static_cast<Eigen::Index>(2 * k); };
  if (i > j) return S.block<2, 2>(at(i), at(j));
  if (i < j) return S.block<2, 2>(at(j), at(i)).transpose();
  const Eigen::Matrix2d own = S.block<2, 2>(at(i), at(i));
  return own.selfadjointView<Eigen::Lower>();
}

}  // namespace

Eigen::Matrix2d OnePointRansac::left_of(const JointCovariance& S, std::size_t j, std::size_t i) {
  const Eigen::Matrix2d S_ji = block(S, j, i);
  return block(S, j, j) - S_ji * block(S, i, i).inverse() * S_ji.transpose();
}

/// And flags in tried_ those that agree. Infinite where the observation is outside of its gate.
double OnePointRansac::cost_with(std::size_t i, const JointCovariance& S, std::span<const Eigen::Vector2d> nu,
                                 double own_gate, double gate) {
  const Eigen::Matrix2d S_ii = block(S, i, i);
  const auto own = mahalanobis_squared<2>(nu[i], S_ii);
  if (!own || *own > own_gate) return HUGE_VAL;
  const Eigen::Matrix2d S_ii_inverse = S_ii.inverse();
  double cost = *own;
  for (std::size_t j = 0; j < nu.size(); ++j) {
    tried_[j] = j == i ? 1 : 0;
    if (j == i) continue;
    const Eigen::Matrix2d S_ji = block(S, j, i);
    const Eigen::Matrix2d A = S_ji * S_ii_inverse;
    const auto d2 = mahalanobis_squared<2>(nu[j] - A * nu[i], block(S, j, j) - A * S_ji.transpose());
    tried_[j] = d2 && *d2 <= gate ? 1 : 0;
    cost += d2 ? std::min(*d2, gate) : gate;
  }
  return cost;
}

OnePointRansac::Rest OnePointRansac::rest(const JointCovariance& S, std::span<const Eigen::Vector2d> nu,
                                          std::size_t i, std::span<const std::size_t> some) {
  const Eigen::Matrix2d S_ii_inverse = block(S, i, i).inverse();
  const auto at = [](std::size_t k) { return static_cast<Eigen::Index>(2 * k); };
  rest_nu_.clear();
  for (std::size_t a = 0; a < some.size(); ++a) {
    const Eigen::Matrix2d A = block(S, some[a], i) * S_ii_inverse;
    rest_nu_.emplace_back(nu[some[a]] - A * nu[i]);
    for (std::size_t b = 0; b <= a; ++b)
      rest_covariance_.block<2, 2>(at(a), at(b)) = block(S, some[a], some[b]) - A * block(S, i, some[b]);
  }
  return {rest_covariance_.topLeftCorner(at(some.size()), at(some.size())), rest_nu_};
}

double OnePointRansac::false_alarms(const JointCovariance& S, double own_gate, double gate,
                                    double area_px2) const {
  double expected = 0.0;
  double agreeing = 0.0;
  for (std::size_t j = 0; j < best_.size(); ++j) {
    if (j == hypothesis_) continue;
    agreeing += best_[j];
    const double anywhere =
        std::min(std::numbers::pi * own_gate * std::sqrt(block(S, j, j).determinant()), area_px2);
    const double here = std::numbers::pi * gate * std::sqrt(left_of(S, j, hypothesis_).determinant());
    expected += std::min(1.0, here / anywhere);
  }
  const auto tried = static_cast<double>(best_.size());
  if (!(agreeing > expected)) return tried;
  return tried * std::exp(agreeing - expected + agreeing * std::log(expected / agreeing));
}

std::span<const char> OnePointRansac::best(const JointCovariance& S, std::span<const Eigen::Vector2d> nu,
                                           double own_gate, double gate) {
  best_.assign(nu.size(), 0);
  tried_.resize(nu.size());
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < nu.size(); ++i) {
    const double cost = cost_with(i, S, nu, own_gate, gate);
    if (!(cost < least)) continue;
    least = cost;
    hypothesis_ = i;
    std::swap(best_, tried_);
    tried_.resize(nu.size());
  }
  return best_;
}

}  // namespace waymark::ekf
