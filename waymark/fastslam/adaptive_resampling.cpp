#include "waymark/fastslam/adaptive_resampling.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "waymark/core/random.hpp"

namespace waymark::fastslam {

AdaptiveResampling::AdaptiveResampling(const FastSlamOptions& options, ParticleBlocks& blocks)
    : temper_below_(options.temper_below),
      resample_below_(options.resample_below),
      kld_error_(options.kld_error),
      kld_least_(std::min(options.kld_least, options.particles)),
      most_(options.particles),
      resampling_(blocks),
      bins_(options.kld_error > 0.0 ? static_cast<std::size_t>(options.particles) : 1) {}

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
  belief.resample(resampling_.choose_ancestors(particles.weights(), u, next_count(particles)));
  ++resamplings_;
}

/// As many as the spread of the set wants (Fox 2003), or always the same.
std::size_t AdaptiveResampling::next_count(const Particles& particles) {
  if (!(kld_error_ > 0.0)) return particles.weights().size();
  const double wanted = std::ceil(kld_particles(bins_.count(particles), kld_error_));
  return static_cast<std::size_t>(
      std::clamp(wanted, static_cast<double>(kld_least_), static_cast<double>(most_)));
}

}  // namespace waymark::fastslam
