#pragma once

#include <array>
#include <cstddef>

#include "waymark/kernels/particle_poses.hpp"

/// Weights are doubles: they span many orders of magnitude and are added up over many particles. Arrays are
/// padded to kParticleLanes entries; the padding is neither read nor counted, and may be written.
namespace waymark::kernels {

/// The largest finite entry, or minus infinity.
double largest_finite(const double* log_weight, std::size_t count);

/// log_weight -= largest, and weight = exp(log_weight); what is not finite weighs nothing. Returns their sum.
double exponentiate(double largest, double* log_weight, double* weight, std::size_t count);

/// sum w and sum w^2 with w = exp(power log_weight).
std::array<double, 2> sum_powers(const double* log_weight, double power, std::size_t count);

void scale(double factor, double* values, std::size_t count);

/// sum w (1, x, y, t, xx, xy, xt, yy, yt, tt) of poses less a reference near them, t within half a turn.
using PoseSums = std::array<double, 10>;
PoseSums sum_poses(const WorldPoses& world, const double* weight, const std::array<double, 3>& reference,
                   std::size_t count);

namespace reference {
double exponentiate(double largest, double* log_weight, double* weight, std::size_t count);
std::array<double, 2> sum_powers(const double* log_weight, double power, std::size_t count);
PoseSums sum_poses(const WorldPoses& world, const double* weight, const std::array<double, 3>& reference,
                   std::size_t count);
}  // namespace reference
}  // namespace waymark::kernels
