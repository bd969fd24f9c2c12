#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/ekf/update.hpp"

namespace waymark::ekf {

/// Which of the pixel observations of one image agree with each other: 1-point RANSAC (Civera, Grasa,
/// Davison, Montiel 2010), which lets one observation correct the state and counts those that are then where
/// they should be. Here every observation gets its turn, not a random few, and what remains uncertain of the
/// others counts: with S the innovation covariance of all, an observation j agrees with i where
///
///     r = nu_j - S_ji S_ii^-1 nu_i,   d_j^2 = r^T (S_jj - S_ji S_ii^-1 S_ij)^-1 r <= gate
///
/// The best i is that of the smallest nu_i^T S_ii^-1 nu_i + sum over j of min(d_j^2, gate) (Torr and
/// Zisserman 2000): a wrong place that others share must still be paid for.
class OnePointRansac {
 public:
  /// Room for so many observations.
  explicit OnePointRansac(std::size_t capacity)
      : best_(capacity), tried_(capacity), rest_covariance_(2 * capacity, 2 * capacity) {
    rest_nu_.reserve(capacity);
  }

  /// What is left of S_jj where observation i is known: how far it may still lead the state.
  [[nodiscard]] static Eigen::Matrix2d left_of(const JointCovariance& S, std::size_t j, std::size_t i);

  /// Joint covariance, lower triangle, and innovations of some observations.
  struct Rest {
    JointCovariance S;
    std::span<const Eigen::Vector2d> nu;
  };
  /// ... of those named by `some` where observation i is known. Valid until the next call.
  [[nodiscard]] Rest rest(const JointCovariance& S, std::span<const Eigen::Vector2d> nu, std::size_t i,
                          std::span<const std::size_t> some);
  /// How many observations that look right in wrong places would agree as many with one of them: each
  /// anywhere in its own ellipse of `gate`, or in `area_px2` where that is smaller (Desolneux, Moisan and
  /// Morel 2000). After best(); a bound (Chernoff).
  [[nodiscard]] double false_alarms(const JointCovariance& S, double own_gate, double gate,
                                    double area_px2) const;

  /// Those that agree with the best of their own, itself within `own_gate`. One flag per observation, all
  /// zero where none is within its gate. `S` holds the lower triangle for two rows per observation. Valid
  /// until the next call. O(observations^2).
  [[nodiscard]] std::span<const char> best(const JointCovariance& S, std::span<const Eigen::Vector2d> nu,
                                           double own_gate, double gate);

 private:
  double cost_with(std::size_t i, const JointCovariance& S, std::span<const Eigen::Vector2d> nu,
                   double own_gate, double gate);

  std::size_t hypothesis_ = 0;  // with which the others were compared, after best() found one
  std::vector<char> best_;
  std::vector<char> tried_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rest_covariance_;
  std::vector<Eigen::Vector2d> rest_nu_;
};

}  // namespace waymark::ekf
