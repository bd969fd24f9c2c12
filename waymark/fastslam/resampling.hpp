#pragma once

#include <cstdint>
#include <span>

namespace waymark::fastslam {

/// N_eff = 1 / sum w^2 of weights that sum to 1: how many equally likely particles the set is worth.
[[nodiscard]] double effective_particles(std::span<const double> weights);

/// Systematic (low variance) resampling: writes for each particle the one that it becomes a copy of. Weights
/// are >= 0 with a positive sum W; `u` is uniform in [0, 1). Particle i gets floor or ceil of N w_i / W
/// offspring, N w_i / W on average. One that has any keeps its own place: ancestors[ancestors[i]] ==
/// ancestors[i]. O(N), allocates nothing.
void choose_ancestors(std::span<const double> weights, double u, std::span<std::int32_t> ancestors);

}  // namespace waymark::fastslam
