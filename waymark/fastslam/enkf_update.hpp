#pragma once

#include "waymark/core/aligned_array.hpp"
#include "waymark/fastslam/belief.hpp"
#include "waymark/fastslam/particle_blocks.hpp"
#include "waymark/kernels/particle_observations.hpp"

namespace waymark::fastslam {

/// One number of an observation: its range or its bearing.
struct ScalarObservation {
  kernels::LandmarkObservation observation;
  bool is_bearing = false;
  double variance = 0.0;            ///< of the innovation over the set, the spread of the particles included
  double information_weight = 1.0;  ///< power of its likelihood
};

/// Lets an observation move particles instead of weighing them: the ensemble Kalman filter's half of the
/// ensemble Kalman particle filter (Frei and Kuensch 2013).
///
/// Weights can only choose among the paths that the set happens to hold. Where a loop closes, none may be
/// right, and those that are chosen leave no spread for the next one. But the set knows how its poses and
/// maps vary with what they expect to see. With nu the innovation of a particle, C its variance over the set
/// and r the noise that it has in each particle, every number v of a particle (pose, point, anchor,
/// direction) moves to
///     v + K (mean nu + (nu - mean nu) / 2),   K = -cov(v, nu) / (C + r).
/// Half the gain on what is particular to a particle leaves the set with the posterior's spread, to first
/// order in K, without random numbers (Sakov and Oke 2008). A correlation that so few particles may show by
/// chance is damped: with c its square, K is multiplied by 1 - (1 - c) / ((N_eff - 2) c), at least 0.
class EnkfUpdate {
 public:
  /// `blocks`, those of the belief, must outlive it.
  explicit EnkfUpdate(ParticleBlocks& blocks);

  /// Assimilates the number, which is expected from where the pending motion ends: particles, calibration and
  /// maps move. Of several hypotheses the mean innovation counts. Gathers every landmark: O(N landmarks).
  void assimilate(const ScalarObservation& z, Belief& belief);

 private:
  /// The innovations of all particles.
  struct Innovations {
    double mean = 0.0;
    double variance = 0.0;
    double effective = 0.0;  ///< particles
    double unbiased = 1.0;   ///< factor that makes weighted sample moments unbiased
  };

  void list_innovations(const ScalarObservation& z, const Belief& belief);
  [[nodiscard]] double gain_of(const float* values);
  void move_values(double* values, bool is_angle);
  void move_landmark(const kernels::LandmarkView& landmark);
  void move_column(float* column, const float* log_weight);
  [[nodiscard]] const float* alive(const float* column, const float* log_weight);

  ParticleBlocks& blocks_;
  AlignedArray<float> weight_;
  AlignedArray<float> delta_;   ///< innovation less its mean
  AlignedArray<float> step_;    ///< how far a number of unit gain moves
  AlignedArray<float> values_;  ///< a number of the poses, less that of the first one
  Innovations innovations_;
  double noise_ = 0.0;
};

}  // namespace waymark::fastslam
