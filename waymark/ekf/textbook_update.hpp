#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "waymark/ekf/covariance.hpp"
#include "waymark/ekf/linearized_observation.hpp"
#include "waymark/ekf/state_layout.hpp"

namespace waymark::ekf {

/// A row-major matrix whose memory is taken once.
class DenseMatrix {
 public:
  explicit DenseMatrix(std::size_t max_rows, std::size_t max_columns) {
    values_.reserve(max_rows * max_columns);
  }

  /// Zeros, of a size that there is room for.
  void reset(std::size_t rows, std::size_t columns) {
    values_.assign(rows * columns, 0.0);
    rows_ = rows;
    columns_ = columns;
  }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] double& operator()(std::size_t i, std::size_t j) { return values_[i * columns_ + j]; }
  [[nodiscard]] double operator()(std::size_t i, std::size_t j) const { return values_[i * columns_ + j]; }

 private:
  std::vector<double> values_;
  std::size_t rows_ = 0;
  std::size_t columns_ = 0;
};

/// The update of an EKF as it is written (Vincke et al. 2012, equations 10 to 12): H and P as dense matrices,
/// products of three nested loops, S inverted. It knows nothing of the zeros in H nor of the symmetry of P:
/// what the fast update is held against, in results and in time.
///
///     S = H P H^T + R,   K = P H^T S^-1,   dx = K nu,   P <- (I - K H) P
///
/// Takes 2 n^3 + O(n^2 D) flop; nothing allocates after construction.
class TextbookUpdate {
 public:
  TextbookUpdate(std::size_t max_rows, std::size_t largest_state);

  /// The update of a state, as Update::propose() and Update::correct(); increments: n.
  [[nodiscard]] bool propose(const Covariance& covariance, const StateLayout& layout,
                             std::span<const LinearizedObservation> linearizations, double* increments);
  void correct(Covariance& covariance);

  /// H and R are zero, everything else is to be set by the caller: nu has `rows` values, P is size x size.
  void begin(std::size_t rows, std::size_t size);
  /// Finds dx; H, P, R and nu stay. False if S is not positive definite.
  [[nodiscard]] bool solve();
  /// P <- (I - K H) P, with K of the last solve().
  void correct();

  DenseMatrix H;   ///< D x n
  DenseMatrix R;   ///< D x D
  DenseMatrix P;   ///< n x n
  DenseMatrix nu;  ///< D x 1
  DenseMatrix dx;  ///< n x 1

 private:
  void write_down(const Covariance& covariance, const StateLayout& layout,
                  std::span<const LinearizedObservation> linearizations);
  [[nodiscard]] bool invert_innovation_covariance();

  DenseMatrix PHt_;        // n x D
  DenseMatrix S_;          // D x D
  DenseMatrix S_inverse_;  // D x D
  DenseMatrix K_;          // n x D
  DenseMatrix I_KH_;       // n x n
  DenseMatrix P_new_;      // n x n
};

}  // namespace waymark::ekf
