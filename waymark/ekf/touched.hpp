#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace waymark::ekf {

/// The part that a pair of biases has in something linear: J times its two values, by row. A pair
/// below 0 has none.
struct ErrorTerm {
  int pair = -1;
  Eigen::Matrix<double, 3, 2> J = Eigen::Matrix<double, 3, 2>::Zero();

  [[nodiscard]] bool takes_part() const { return pair >= 0; }
};
/// At most so many at once.
inline constexpr int kErrorTerms = 3;
using ErrorTerms = std::array<ErrorTerm, kErrorTerms>;

/// Row of the state at which a pair of biases begins: they come right after the robot.
[[nodiscard]] constexpr std::size_t error_offset(int pair) { return 3 + 2 * static_cast<std::size_t>(pair); }

/// What something linear depends on: rows of the state, and its Jacobian to them. First the robot, then
/// biases, then landmarks.
struct Touched {
  static constexpr int kMost = 12 + 2 * kErrorTerms;

  /// The robot and the errors, with `landmark` columns of zeros for landmarks' rows, which are not set.
  template <class JacobianToPose>
  Touched(const JacobianToPose& J_pose, const ErrorTerms& errors, int landmark = 0) : rows{0, 1, 2} {
    const auto pairs = static_cast<int>(std::ranges::count_if(errors, &ErrorTerm::takes_part));
    head = 3 + 2 * pairs;
    J.setZero(J_pose.rows(), head + landmark);
    J.leftCols(3) = J_pose;
    int column = 3;
    for (const ErrorTerm& error : errors) {
      if (!error.takes_part()) continue;
      J.middleCols(column, 2) = error.J.topRows(J_pose.rows());
      for (std::size_t k = 0; k < 2; ++k)
        rows[static_cast<std::size_t>(column++)] = error_offset(error.pair) + k;
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

  std::array<std::size_t, kMost> rows;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 3, kMost> J;
  int head;  ///< columns before the landmarks'
};

}  // namespace waymark::ekf
