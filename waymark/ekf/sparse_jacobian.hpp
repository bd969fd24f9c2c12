#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace waymark::ekf {

/// The part that a pair of biases has in something linear: J times its two values, by row. A pair
/// below 0 has none.
struct BiasTerm {
  int pair = -1;
  Eigen::Matrix<double, 3, 2> J = Eigen::Matrix<double, 3, 2>::Zero();

  [[nodiscard]] bool takes_part() const { return pair >= 0; }
};
/// At most so many at once.
inline constexpr int kBiasTerms = 3;
using BiasTerms = std::array<BiasTerm, kBiasTerms>;

/// Row of the state at which a pair of biases begins: they come right after the robot.
[[nodiscard]] constexpr std::size_t bias_offset(int pair) { return 3 + 2 * static_cast<std::size_t>(pair); }

/// The Jacobian of something that depends on few values of the state: rows of the state, and the derivatives
/// to them. First the robot, then biases, then landmarks.
struct SparseJacobian {
  /// Rows of the largest observation: the robot, a landmark and two anchors of three values each, and biases.
  static constexpr int kMaxRows = 3 + 3 * 3 + 2 * kBiasTerms;

  /// The robot and the errors, with `landmark` columns of zeros for landmarks' rows, which are not set.
  template <class JacobianToPose>
  SparseJacobian(const JacobianToPose& J_pose, const BiasTerms& errors, int landmark = 0) : rows{0, 1, 2} {
    const auto pairs = static_cast<int>(std::ranges::count_if(errors, &BiasTerm::takes_part));
    head = 3 + 2 * pairs;
    J.setZero(J_pose.rows(), head + landmark);
    J.leftCols(3) = J_pose;
    int column = 3;
    for (const BiasTerm& error : errors) {
      if (!error.takes_part()) continue;
      J.middleCols(column, 2) = error.J.topRows(J_pose.rows());
      for (std::size_t k = 0; k < 2; ++k)
        rows[static_cast<std::size_t>(column++)] = bias_offset(error.pair) + k;
    }
  }

  /// Sets the `count` columns from `column` on to those of a landmark at row `offset` of the state.
  template <class JacobianToLandmark>
  void set_landmark(int column, std::size_t offset, int count, const JacobianToLandmark& J_landmark) {
    J.middleCols(column, count) = J_landmark.topLeftCorner(J.rows(), count);
    for (int k = 0; k < count; ++k)
      rows[static_cast<std::size_t>(column) + static_cast<std::size_t>(k)] =
          offset + static_cast<std::size_t>(k);
  }

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(J.cols()); }

  std::array<std::size_t, kMaxRows> rows;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 3, kMaxRows> J;
  int head;  ///< columns before the landmarks'
};

}  // namespace waymark::ekf
