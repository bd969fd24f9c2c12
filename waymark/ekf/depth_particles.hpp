#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "waymark/ekf/depth_prior.hpp"

namespace waymark::ekf {

/// Where along its ray a point may be: particles over its depth, weighted by every image in which it is
/// found (Davison 2003; Vincke et al. 2012, section 2.4). A particle stands for all depths that are nearer to
/// it than to others, so that a single one that is left is not a depth that is known for sure. Nothing
/// allocates after construction.
class DepthParticles {
 public:
  explicit DepthParticles(const DepthPrior& prior) : prior_(prior) { restart(); }

  /// As if nothing had been seen: uniform over the prior.
  void restart();

  /// log_likelihood(rho) of each particle, rho its inverse depth in 1/m; minus infinity where it is
  /// impossible. Returns the largest.
  template <class LogLikelihood>
  double score(const LogLikelihood& log_likelihood);
  /// Multiplies the weights by the likelihoods of the last score(), which must have been finite somewhere.
  /// Particles of less than 1e-4 of all weight are dropped.
  void take();

  struct Spread {
    double mean;
    double sigma;
  };
  [[nodiscard]] Spread inverse_depth() const {
    return spread([](const Particle& particle) { return Cell{particle.rho_per_m, particle.width_per_m}; });
  }
  [[nodiscard]] Spread depth() const {
    return spread([](const Particle& particle) {
      const double depth_m = 1.0 / particle.rho_per_m;
      return Cell{depth_m, particle.width_per_m * depth_m * depth_m};
    });
  }
  [[nodiscard]] std::size_t size() const { return particles_.size(); }
  /// What is believed, for people to look at: inverse depth (1/m) and weight of each particle. Allocates.
  struct Weighted {
    double rho_per_m;
    double weight;
  };
  [[nodiscard]] std::vector<Weighted> weighted() const;

 private:
  struct Particle {
    double rho_per_m;
    double width_per_m;  ///< of the inverse depths that it stands for
    double weight;
    double log_likelihood;
  };
  struct Cell {
    double middle;
    double width;
  };
  static constexpr double kMinWeight = 1e-4;

  template <class CellOf>
  [[nodiscard]] Spread spread(const CellOf& cell_of) const;
  [[nodiscard]] double total() const;

  DepthPrior prior_;
  std::vector<Particle> particles_;
  double best_ = 0.0;  ///< log likelihood of the last score()
};

template <class LogLikelihood>
double DepthParticles::score(const LogLikelihood& log_likelihood) {
  best_ = -HUGE_VAL;
  for (Particle& particle : particles_) {
    particle.log_likelihood = log_likelihood(particle.rho_per_m);
    best_ = std::max(best_, particle.log_likelihood);
  }
  return best_;
}

template <class CellOf>
DepthParticles::Spread DepthParticles::spread(const CellOf& cell_of) const {
  double mean = 0.0, square = 0.0;
  for (const Particle& particle : particles_) mean += particle.weight * cell_of(particle).middle;
  for (const Particle& particle : particles_) {
    const auto [middle, width] = cell_of(particle);
    const double d = middle - mean;
    square += particle.weight * (d * d + width * width / 12.0);
  }
  return {mean, std::sqrt(square)};
}

}  // namespace waymark::ekf
