#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "waymark/core/aligned_array.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/fastslam/particle_blocks.hpp"
#include "waymark/kernels/particle_poses.hpp"

namespace waymark::fastslam {

/// Robot poses T_world_robot of all particles and how likely each is: one aligned array per quantity, padded
/// as kernels want it.
class Particles {
 public:
  /// All at one pose, equally likely. There is room for so many and no more.
  Particles(int capacity, const Pose2& T_world_robot);

  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] Pose2 pose(int i) const;
  void set_pose(int i, const Pose2& T_world_robot);

  [[nodiscard]] std::span<double> weights() { return {weight_.data(), size()}; }
  [[nodiscard]] std::span<const double> weights() const { return {weight_.data(), size()}; }
  [[nodiscard]] std::span<double> log_weights() { return {log_weight_.data(), size()}; }
  [[nodiscard]] std::span<const double> log_weights() const { return {log_weight_.data(), size()}; }
  /// From particle `first` on.
  [[nodiscard]] kernels::WorldPoses world(std::size_t first = 0) const {
    return {x_m_.data() + first, y_m_.data() + first, theta_rad_.data() + first};
  }
  [[nodiscard]] kernels::MovingPoses moving(std::size_t first = 0) {
    return {x_m_.data() + first, y_m_.data() + first, theta_rad_.data() + first};
  }

  void make_weights_equal();

  /// Particle i becomes a copy of particle ancestors[i], there are as many as ancestors, and all weigh the
  /// same. An ancestor that has a place must keep it (see choose_ancestors()), so poses can be copied in
  /// place.
  void replace_by_ancestors(std::span<const std::int32_t> ancestors, ParticleBlocks& blocks);

 private:
  void make_weights_equal(std::size_t begin, std::size_t end);
  void clear_padding();
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(count_); }

  int count_;
  AlignedArray<double> x_m_;
  AlignedArray<double> y_m_;
  AlignedArray<double> theta_rad_;   // within a turn
  AlignedArray<double> log_weight_;  // up to a constant
  AlignedArray<double> weight_;      // as of the last normalise_weights(); sums to 1
};

/// weight = exp(log_weight), scaled to sum 1. A particle whose log weight is not finite weighs nothing.
/// False, and all weights equal, if that leaves none.
[[nodiscard]] bool normalise_weights(Particles& particles, ParticleBlocks& blocks);

/// Flattens normalised weights to w^beta with the largest beta <= 1 at which N_eff is `min_effective`,
/// which must be below the number of particles that weigh anything. Does nothing if N_eff is larger already.
void temper_weights(Particles& particles, double min_effective, ParticleBlocks& blocks);

/// Weighted mean, circular for the heading, and covariance about it.
[[nodiscard]] PoseEstimate estimate(const Particles& particles, ParticleBlocks& blocks);

}  // namespace waymark::fastslam
