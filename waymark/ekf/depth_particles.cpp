#include "waymark/ekf/depth_particles.hpp"

namespace waymark::ekf {

void DepthParticles::restart() {
  const auto count = static_cast<std::size_t>(prior_.particles);
  particles_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double part = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const double depth_m = prior_.nearest_m + part * (prior_.farthest_m - prior_.nearest_m);
    const double rho = 1.0 / prior_.nearest_m + part * (1.0 / prior_.farthest_m - 1.0 / prior_.nearest_m);
    particles_[i] = {prior_.spacing == DepthPrior::Spacing::kDepth ? 1.0 / depth_m : rho,
                     1.0 / static_cast<double>(count), 0.0};
  }
}

double DepthParticles::total() const {
  double sum = 0.0;
  for (const Particle& particle : particles_) sum += particle.weight;
  return sum;
}

void DepthParticles::take() {
  for (Particle& particle : particles_) particle.weight *= std::exp(particle.log_likelihood - best_);
  const double least = kLeastWeight * total();
  std::erase_if(particles_, [least](const Particle& particle) { return particle.weight < least; });
  const double scale = 1.0 / total();
  for (Particle& particle : particles_) particle.weight *= scale;
}

}  // namespace waymark::ekf
