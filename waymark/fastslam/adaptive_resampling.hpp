#pragma once

#include <cstdint>

#include "waymark/fastslam/belief.hpp"
#include "waymark/fastslam/fast_slam_options.hpp"
#include "waymark/fastslam/resampling.hpp"

namespace waymark::fastslam {

/// Keeps the set of particles alive: weights never collapse onto a few particles, and the set is resampled
/// when too few of them count.
class AdaptiveResampling {
 public:
  /// `blocks` must outlive it.
  AdaptiveResampling(const FastSlamOptions& options, ParticleBlocks& blocks);

  /// Normalises the weights after a step, and flattens them to keep FastSlamOptions::temper_below effective.
  /// False, and all weights equal, if no particle weighs anything. O(N).
  [[nodiscard]] bool normalise(Belief& belief) const;

  /// Resamples the set if N_eff is below FastSlamOptions::resample_below. Only after a motion: clones of a
  /// robot that stands still would stay clones.
  void resample(Belief& belief);

  /// How often the set was resampled.
  [[nodiscard]] std::int64_t resamplings() const { return resamplings_; }

 private:
  double temper_below_;
  double resample_below_;
  Resampling resampling_;
  std::int64_t resamplings_ = 0;
};

}  // namespace waymark::fastslam
