#include "waymark/fastslam/adaptive_resampling.hpp"

#include <utility>

#include "waymark/core/random.hpp"

namespace waymark::fastslam {

AdaptiveResampling::AdaptiveResampling(const FastSlamOptions& options, ParticleBlocks& blocks)
    : temper_below_(options.temper_below), resample_below_(options.resample_below), resampling_(blocks) {}

bool AdaptiveResampling::normalise(Belief& belief) const {
  if (!normalise_weights(belief.particles, belief.blocks)) return false;
  temper_weights(belief.particles, temper_below_ * belief.particles.count(), belief.blocks);
  return true;
}

void AdaptiveResampling::resample(Belief& belief) {
  const Particles& particles = belief.particles;
  const bool has_moved = std::exchange(belief.has_moved, false);
  if (!has_moved || effective_particles(particles.weights()) >= resample_below_ * particles.count()) return;
  const double u = RandomStream(belief.seed, StreamPurpose::kResampling, belief.steps).uniform();
  belief.resample(resampling_.choose_ancestors(particles.weights(), u));
  ++resamplings_;
}

}  // namespace waymark::fastslam
