#pragma once

#include <cstddef>

#include "waymark/kernels/particle_columns.hpp"

namespace waymark::kernels {

/// sum w (d, d delta, d^2) over a column of values v, d = v - base.
struct RegressionSums {
  double d = 0.0;
  double d_delta = 0.0;
  double d_d = 0.0;
};

RegressionSums sum_regression(const float* values, float base, const float* weight, const float* delta,
                              std::size_t count);

/// values += factor * step
void add_scaled(float factor, const float* step, float* values, std::size_t count);

namespace reference {
RegressionSums sum_regression(const float* values, float base, const float* weight, const float* delta,
                              std::size_t count);
}  // namespace reference
}  // namespace waymark::kernels
