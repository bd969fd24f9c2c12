#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "waymark/core/motion.hpp"
#include "waymark/core/random.hpp"
#include "waymark/fastslam/particle_blocks.hpp"
#include "waymark/fastslam/particles.hpp"
#include "waymark/kernels/particle_observations.hpp"

namespace waymark::fastslam {

/// Which random numbers a step draws: particle i uses the stream (seed, purpose, step, i).
struct StreamKey {
  std::uint64_t seed = 0;
  StreamPurpose purpose = StreamPurpose::kMotion;
  std::uint64_t step = 0;
};

/// An observation that particles take in.
struct AcceptedObservation {
  kernels::LandmarkObservation observation;
  double exponent = 1.0;  ///< the power of its likelihood that the weights take
  bool shapes_motion =
      false;  ///< particles draw their motion knowing it; else they are weighed after the draw
  const float* takers = nullptr;  ///< the observation is for particles with 1 here, not for those with 0;
                                  ///< null: it is for all
};

/// One step of all particles, block by block, each block with all that it does while it is in the cache.
/// Every particle takes the motion as N(mu, P) in its own frame, lets the observations that shape it in one
/// after the other (FastSLAM 2.0, Montemerlo et al. 2003; without any it is FastSLAM 1.0), draws where it
/// goes, and updates the landmarks seen from there. Weights collect in the particles' log weights.
///
/// Positions in `observations` are counted from `origin_m`. Allocates nothing.
void step(Particles& particles, const Motion& motion, const Eigen::Vector2d& origin_m,
          std::span<const AcceptedObservation> observations, const StreamKey& key, ParticleBlocks& blocks);

[[nodiscard]] kernels::Increment increment_of(const Motion& motion);

/// Room for the columns that a block of particles needs while it is worked on.
class BlockScratch {
 public:
  [[nodiscard]] kernels::PoseColumns robots() { return {column(0), column(1), column(2), column(3)}; }
  [[nodiscard]] kernels::PoseColumns sensors() { return {column(4), column(5), column(6), column(7)}; }
  [[nodiscard]] kernels::IncrementColumns increments() {
    return {column(8),  column(9),  column(10), column(11), column(12),
            column(13), column(14), column(15), column(16)};
  }
  [[nodiscard]] float* normals(int k) { return column(17 + k); }

 private:
  static constexpr int kColumns = 20;
  [[nodiscard]] float* column(int k) { return values_[k]; }
  alignas(64) float values_[kColumns][ParticleBlocks::kBlockSize];
};

/// Where the sensors of a block of particles are, from `origin_m`: columns of the scratch.
[[nodiscard]] kernels::PoseColumns load_sensors(const Particles& particles, const kernels::SensorMount& mount,
                                                const Eigen::Vector2d& origin_m, kernels::ParticleRange range,
                                                BlockScratch& scratch);

}  // namespace waymark::fastslam
