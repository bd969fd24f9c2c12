#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "waymark/core/aligned_array.hpp"
#include "waymark/fastslam/particle_blocks.hpp"

namespace waymark::fastslam {

/// N_eff = 1 / sum w^2 of weights that sum to 1: how many equally likely particles the set is worth.
[[nodiscard]] double effective_particles(std::span<const double> weights);

/// Systematic (low variance) resampling. Its results do not depend on the number of threads, and it allocates
/// only when it is made.
class Resampling {
 public:
  /// `blocks` must outlive it.
  explicit Resampling(ParticleBlocks& blocks);

  /// For each new particle the one that it becomes a copy of. Weights, one per particle of the
  /// blocks, are >= 0 with a positive sum W; `u` is uniform in [0, 1). Particle i gets floor or ceil of N w_i
  /// / W offspring, N w_i / W on average. One that has any keeps its own place:
  /// ancestors[ancestors[i]] == ancestors[i]. Valid until the next call. O(N).
  [[nodiscard]] std::span<const std::int32_t> choose_ancestors(std::span<const double> weights, double u);

 private:
  /// What the blocks before one hold.
  struct Before {
    double weight = 0.0;
    std::size_t vacant = 0;   ///< places
    std::size_t further = 0;  ///< offspring that need another place
  };

  void count_offspring(std::span<const double> weights, double u);
  void list_vacant();
  void assign_ancestors();
  [[nodiscard]] bool keeps_place(std::size_t i) const { return offspring_[i] > 0; }

  ParticleBlocks& blocks_;
  AlignedArray<std::int32_t> offspring_;
  AlignedArray<std::int32_t> vacant_;
  AlignedArray<std::int32_t> ancestors_;
  std::vector<Before> before_;  // by block, and after the last one
};

}  // namespace waymark::fastslam
