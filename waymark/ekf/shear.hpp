#pragma once

#include <cstddef>
#include <span>

#include "waymark/core/aligned_array.hpp"
#include "waymark/ekf/covariance.hpp"
#include "waymark/ekf/state_layout.hpp"

namespace waymark::ekf {

/// How the ground turns with a correction of the heading by a, in ordinary coordinates (Barrau and Bonnabel
/// 2015): the increment dq of each of its points becomes V(a) dq, and the covariance is sheared,
/// P <- (I + d e_theta^T) P (I + d e_theta^T)^T, along d = J V(a) dq. Biases, heights and what is
/// relative stay: zeros in d.
class Shear {
 public:
  /// For states of up to `capacity` values.
  explicit Shear(std::size_t capacity);

  /// Turns the increments dx of ground points, and with them d. O(n).
  void turn(double* dx, const StateLayout& layout, std::span<const char> relative);
  /// With e = c + c_theta/2 d, where c is the heading's column of P - W^T W, the shear of that is
  /// + d e^T + e d^T. W: D x n, `ld` apart. O(n D).
  void prepare(const Covariance& P, const double* W, std::size_t ld, std::size_t D);

  [[nodiscard]] const double* d() const { return d_.data(); }
  [[nodiscard]] const double* e() const { return e_.data(); }

 private:
  AlignedArray<double> d_;
  AlignedArray<double> e_;
};

}  // namespace waymark::ekf
