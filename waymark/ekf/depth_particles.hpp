#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "waymark/core/config.hpp"

namespace waymark::ekf {

/// How far away something may be that was seen once.
struct DepthPrior {
  enum class Spacing { kInverseDepth, kDepth };

  int particles = 100;
  double nearest_m = 0.5;
  double farthest_m = 15.0;
  Spacing spacing = Spacing::kInverseDepth;
};

/// Where along its ray a point may be: particles over its depth, weighted by every picture in which it is
/// found (Davison 2003; Vincke et al. 2012, section 2.4). Nothing allocates after construction.
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
    return spread([](double rho) { return rho; });
  }
  [[nodiscard]] Spread depth() const {
    return spread([](double rho) { return 1.0 / rho; });
  }
  [[nodiscard]] std::size_t size() const { return particles_.size(); }

 private:
  struct Particle {
    double rho_per_m;
    double weight;
    double log_likelihood;
  };
  static constexpr double kLeastWeight = 1e-4;

  template <class Value>
  [[nodiscard]] Spread spread(const Value& value) const;
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

template <class Value>
DepthParticles::Spread DepthParticles::spread(const Value& value) const {
  double mean = 0.0, square = 0.0;
  for (const Particle& particle : particles_) mean += particle.weight * value(particle.rho_per_m);
  for (const Particle& particle : particles_) {
    const double d = value(particle.rho_per_m) - mean;
    square += particle.weight * d * d;
  }
  return {mean, std::sqrt(square)};
}

}  // namespace waymark::ekf
