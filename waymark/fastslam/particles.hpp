#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "waymark/core/aligned_array.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/core/random.hpp"
#include "waymark/fastslam/particle_blocks.hpp"

namespace waymark::fastslam {

/// Robot poses T_world_robot of all particles and how likely each is: one aligned array per quantity.
struct Particles {
  /// All at one pose, equally likely.
  Particles(int count, const Pose2& T_world_robot);

  [[nodiscard]] int count() const { return static_cast<int>(weight.size()); }
  [[nodiscard]] Pose2 pose(int i) const;
  void set_pose(std::size_t i, const Pose2& T_world_robot);

  AlignedArray<double> x_m;
  AlignedArray<double> y_m;
  AlignedArray<double> theta_rad;  ///< in (-pi, pi]
  AlignedArray<double> cos_theta;  ///< kept beside theta, so that no observation needs trigonometry
  AlignedArray<double> sin_theta;
  AlignedArray<double> log_weight;  ///< up to a constant
  AlignedArray<double> weight;      ///< as of the last normalise_weights(); sums to 1
};

/// Which random numbers a step draws: particle i uses the stream (seed, purpose, step, i).
struct StreamKey {
  std::uint64_t seed = 0;
  StreamPurpose purpose = StreamPurpose::kMotion;
  std::uint64_t step = 0;
};

/// L with L L^T = Q for a covariance of any rank (Cholesky, vanishing pivots set to 0): motion without slip
/// has rank 2.
[[nodiscard]] Eigen::Matrix3d semidefinite_root(const Eigen::Matrix3d& Q);

/// Moves each particle by its own draw from the motion. About 0.1 us per particle.
void move(Particles& particles, const Motion& motion, const StreamKey& key, ParticleBlocks& blocks);

/// weight = exp(log_weight), scaled to sum 1. A particle whose log weight is not finite weighs nothing.
/// False, and all weights equal, if that leaves none.
[[nodiscard]] bool normalise_weights(Particles& particles, ParticleBlocks& blocks);

/// Flattens normalised weights to w^beta with the largest beta <= 1 at which N_eff is `least_effective`,
/// which must be below the number of particles that weigh anything. Does nothing if N_eff is larger already.
void temper_weights(Particles& particles, double least_effective, ParticleBlocks& blocks);

void make_weights_equal(Particles& particles);

/// Weighted mean, circular for the heading, and covariance about it.
[[nodiscard]] PoseEstimate estimate(const Particles& particles, ParticleBlocks& blocks);

/// Particle i becomes a copy of particle ancestors[i], and all weigh the same. An ancestor must be its own
/// ancestor (see choose_ancestors()), so poses can be copied in place.
void replace_by_ancestors(Particles& particles, std::span<const std::int32_t> ancestors,
                          ParticleBlocks& blocks);

}  // namespace waymark::fastslam
