#include "waymark/ekf/shear.hpp"

#include <algorithm>
#include <array>

#include "waymark/ekf/consistency.hpp"
#include "waymark/ekf/update.hpp"
#include "waymark/kernels/add_scaled_rows.hpp"
#include "waymark/kernels/layout.hpp"
#include "waymark/kernels/symmetric_rows.hpp"

namespace waymark::ekf {

Shear::Shear(std::size_t capacity)
    : d_(kernels::padded_stride(capacity)), e_(kernels::padded_stride(capacity)) {}

void Shear::turn(double* dx, const StateLayout& layout, std::span<const char> relative) {
  const Retraction retraction(Consistency::kInvariant, dx[2]);
  std::fill_n(d_.data(), layout.size(), 0.0);
  const auto turn_point = [&](std::size_t at) {
    Eigen::Map<Eigen::Vector2d> moved(dx + at);
    Eigen::Map<Eigen::Vector2d> d(&d_[at]);
    moved = retraction.displacement(moved);
    d = retraction.shear(moved);
  };
  turn_point(0);
  for (int i = 0; i < layout.landmarks; ++i)
    if (relative[static_cast<std::size_t>(i)] == 0) turn_point(layout.offset(i));
}

void Shear::prepare(const Covariance& P, const double* W, std::size_t ld, std::size_t D) {
  const std::size_t n = P.size();
  kernels::gather_rows(P.data(), P.stride(), n, 2, 1, e_.data(), P.stride());
  std::array<double, Update::kMaxRows> w_heading;
  for (std::size_t k = 0; k < D; ++k) w_heading[k] = -W[k * ld + 2];
  kernels::add_scaled_rows(e_.data(), W, ld, D, w_heading.data(), n);
  const double half_c_theta = 0.5 * e_[2];
  for (std::size_t j = 0; j < n; ++j) e_[j] += half_c_theta * d_[j];
}

}  // namespace waymark::ekf
