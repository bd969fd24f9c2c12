#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <span>

#include <Eigen/Core>

#include "waymark/core/aligned_array.hpp"
#include "waymark/core/parallel.hpp"
#include "waymark/ekf/covariance.hpp"
#include "waymark/ekf/linearized_observation.hpp"
#include "waymark/ekf/shear.hpp"
#include "waymark/ekf/state_layout.hpp"
#include "waymark/ekf/textbook_update.hpp"

namespace waymark::ekf {

/// What an update did, for a filter that remembers more than the state holds. Views into the state, good
/// until it is next changed.
struct Gain {
  std::size_t rows;  ///< D, measurement rows
  std::size_t ld;    ///< stride of W
  const double* W;   ///< D x n: L^-1 H P, so that P <- P - W^T W
  std::size_t ld_l;  ///< stride of L
  const double* L;   ///< D x D, lower: L L^T = H P H^T + R
  const double* nu;  ///< D: L^-1 nu, so that dx = W^T nu
  const double*
      shear;  ///< n: d of the invariant filter's shear P <- (I + d e_theta^T) P (I + d e_theta^T)^T, or null
  double turn;  ///< change of heading, rad
};

/// Its lower triangle counts.
using JointCovariance =
    Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, 0,
               Eigen::OuterStride<>>;

/// The update with several observations at once, exactly, in two steps (Vincke et al. 2012, equations 10 to
/// 12, where the observations bring nu of equation 10):
///
///     C = H P,   S = C H^T + R = L L^T,   W = L^-1 C,   dx = W^T L^-1 nu     propose()
///     P <- P - W^T W                                                         correct()
///
/// so that no gain is formed: K = W^T L^-1. n^2 D flop; nothing allocates after construction.
class Update {
 public:
  /// Most observations, and measurement rows, that are taken at once.
  static constexpr int kMaxObservations = 32;
  static constexpr std::size_t kMaxRows = 2 * kMaxObservations;

  /// For states of up to `capacity` values; `threads` share what is large.
  Update(std::size_t capacity, int threads);

  /// From now on all is computed by TextbookUpdate; takes the memory for that. gain() is not to be had.
  void use_textbook();
  [[nodiscard]] bool is_textbook() const { return textbook_ != nullptr; }
  /// From now on the values from row `rows` on stay as they are, in mean and covariance: what they are unsure
  /// of is considered (Schmidt 1966). n D rows flop.
  void consider_all_from(std::size_t rows) { max_rows_ = rows; }

  /// Finds dx; changes nothing. False if S is not positive definite.
  [[nodiscard]] bool propose(const Covariance& P, const StateLayout& layout,
                             std::span<const LinearizedObservation> linearizations);
  /// The increments of the state, n, that were proposed last.
  [[nodiscard]] double* dx() { return dx_.data(); }
  [[nodiscard]] const double* dx() const { return dx_.data(); }
  /// What was proposed last does its part to the covariance; then `shear`, unless it is null.
  void correct(Covariance& P, Shear* shear);
  /// Of the last correct(), without a shear; nothing else may have happened since.
  [[nodiscard]] Gain gain() const;

  /// S of all these observations together. Drops what was proposed. A view, good until the next call.
  [[nodiscard]] JointCovariance joint_innovation_covariance(
      const Covariance& P, const StateLayout& layout, std::span<const LinearizedObservation> linearizations);

 private:
  void form_innovation_covariance(const Covariance& P, const StateLayout& layout,
                                  std::span<const LinearizedObservation> linearizations);
  [[nodiscard]] bool factorize();
  [[nodiscard]] std::size_t updated_rows(std::size_t n) const { return std::min(n, max_rows_); }

  std::size_t ld_;
  AlignedArray<double> W_;                                                    // D x n: C, then W
  AlignedArray<double> dx_;                                                   // n
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> S_;  // D x D, then L
  Eigen::VectorXd nu_;                                                        // D, then L^-1 nu
  std::size_t rows_ = 0;                                                      // D
  std::size_t max_rows_ = std::numeric_limits<std::size_t>::max();            // that change
  ThreadPool thread_pool_;
  std::unique_ptr<TextbookUpdate> textbook_;  // where that is used
};

}  // namespace waymark::ekf
