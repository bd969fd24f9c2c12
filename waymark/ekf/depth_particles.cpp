#include "waymark/ekf/depth_particles.hpp"

namespace waymark::ekf {

void DepthParticles::restart() {
  const auto count = static_cast<std::size_t>(prior_.particles);
  particles_.resize(count);
  const auto cells = static_cast<double>(count);
  const double nearest_per_m = 1.0 / prior_.nearest_m, farthest_per_m = 1.0 / prior_.farthest_m;
  const double step_m = (prior_.farthest_m - prior_.nearest_m) / cells;
  const double step_per_m = (nearest_per_m - farthest_per_m) / cells;
  for (std::size_t i = 0; i < count; ++i) {
    const double steps = static_cast<double>(i) + 0.5;
    if (prior_.spacing == DepthPrior::Spacing::kDepth) {
      const double rho = 1.0 / (prior_.nearest_m + steps * step_m);
      particles_[i] = {rho, step_m * rho * rho, 1.0 / cells, 0.0};
    } else {
      particles_[i] = {nearest_per_m - steps * step_per_m, step_per_m, 1.0 / cells, 0.0};
    }
  }
}

std::vector<DepthParticles::Weighted> DepthParticles::weighted() const {
  std::vector<Weighted> all;
  for (const Particle& particle : particles_) all.push_back({particle.rho_per_m, particle.weight});
  return all;
}

double DepthParticles::total() const {
  double sum = 0.0;
  for (const Particle& particle : particles_) sum += particle.weight;
  return sum;
}

void DepthParticles::take() {
  for (Particle& particle : particles_) particle.weight *= std::exp(particle.log_likelihood - best_);
  const double least = kMinWeight * total();
  std::erase_if(particles_, [least](const Particle& particle) { return particle.weight < least; });
  const double scale = 1.0 / total();
  for (Particle& particle : particles_) particle.weight *= scale;
}

}  // namespace waymark::ekf
