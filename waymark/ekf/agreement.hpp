#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace waymark::ekf {

/// Which of the pixel sightings of one picture agree with each other: 1-point RANSAC (Civera, Grasa, Davison,
/// Montiel 2010), which lets one sighting correct the state and counts those that are then where they should
/// be. Here every sighting gets its turn, not a random few, and what remains uncertain of the others counts:
/// with S the innovation covariance of all, a sighting j agrees with i where
///
///     r = nu_j - S_ji S_ii^-1 nu_i,   r^T (S_jj - S_ji S_ii^-1 S_ij)^-1 r <= gate
class Agreement {
 public:
  using JointCovariance =
      Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, 0,
                 Eigen::OuterStride<>>;

  /// Room for so many sightings.
  explicit Agreement(std::size_t capacity) : largest_(capacity), tried_(capacity) {}

  /// The largest set that agrees with one of its own, itself within the gate; of equally large ones that of
  /// the smallest residuals. One flag per sighting, all zero where none is within its gate. `S` holds the
  /// lower triangle for two rows per sighting. Valid until the next call. O(sightings^2).
  [[nodiscard]] std::span<const char> largest(const JointCovariance& S, std::span<const Eigen::Vector2d> nu,
                                              double gate);

 private:
  struct Score {
    int count = 0;
    double residual2 = 0.0;
    [[nodiscard]] bool beats(const Score& other) const {
      return count > other.count || (count == other.count && residual2 < other.residual2);
    }
  };
  Score try_with(std::size_t i, const JointCovariance& S, std::span<const Eigen::Vector2d> nu, double gate);

  std::vector<char> largest_;
  std::vector<char> tried_;
};

}  // namespace waymark::ekf
