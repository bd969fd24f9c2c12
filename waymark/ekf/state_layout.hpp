#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "waymark/core/pose2.hpp"
#include "waymark/ekf/linearized_observation.hpp"
#include "waymark/ekf/sparse_jacobian.hpp"

namespace waymark::ekf {

/// What stands where in a vector of the state: (x, y, theta | biases | landmark 1, landmark 2, ...).
/// The mean has this layout, and so have increments and points of linearisation: `values` is one of them.
struct StateLayout {
  int dimension;     ///< of a landmark: 2 or 3
  std::size_t head;  ///< rows before the first landmark: the robot's and those of the biases
  int landmarks = 0;

  /// Row of a landmark's first coordinate.
  [[nodiscard]] std::size_t offset(int landmark) const {
    return head + static_cast<std::size_t>(landmark * dimension);
  }
  /// n
  [[nodiscard]] std::size_t size() const { return offset(landmarks); }
  /// Row of the i-th value of (x, y, theta, landmarks).
  [[nodiscard]] std::size_t row(int i) const { return static_cast<std::size_t>(i) + (i < 3 ? 0 : head - 3); }

  [[nodiscard]] static Pose2 pose(const double* values) { return {values[0], values[1], values[2]}; }
  /// z is 0 for 2-D landmarks.
  [[nodiscard]] Eigen::Vector3d landmark(const double* values, int index) const {
    const double* p = values + offset(index);
    return {p[0], p[1], dimension == 3 ? p[2] : 0.0};
  }

  /// The rows of the state that the first `rows` rows of an observation depend on.
  [[nodiscard]] SparseJacobian jacobian(const LinearizedObservation& linearization, int rows) const;
};

/// The two values of a pair of biases.
[[nodiscard]] Eigen::Vector2d bias_pair(const double* values, int pair);
/// What biases of these values add up to: the sum of J e.
[[nodiscard]] Eigen::Vector2d bias_part(const double* values, const BiasTerms& terms);

}  // namespace waymark::ekf
