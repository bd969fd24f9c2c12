#pragma once

#include <Eigen/Core>

#include "waymark/core/aligned_array.hpp"
#include "waymark/fastslam/particles.hpp"
#include "waymark/kernels/particle_observations.hpp"

namespace waymark::fastslam {

/// An innovation over particles: (range, bearing), or in the first component what alone was measured. Not
/// finite if any particle's is not.
struct InnovationMoments {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();  ///< of the particles' innovations about the mean
  Eigen::Matrix2d noise = Eigen::Matrix2d::Zero();   ///< mean of the particles' own innovation covariances

  /// Of the mixture of the particles' Gaussians.
  [[nodiscard]] Eigen::Matrix2d covariance() const { return spread + noise; }
};

/// A part of the particles, large enough to tell what the whole set expects to see: the first 1024 at most.
class GateSample {
 public:
  explicit GateSample(int capacity);

  /// The particles as they are now, positions counted from `origin_m`. They must stay until compare().
  void load(const Particles& particles, const Eigen::Vector2d& origin_m);

  /// How an observation compares with what the loaded particles expect when all make the same increment,
  /// which is still to be drawn.
  [[nodiscard]] InnovationMoments compare(const kernels::LandmarkObservation& observation,
                                          const kernels::Increment& increment);

 private:
  [[nodiscard]] kernels::PoseColumns columns(std::size_t begin);

  std::size_t stride_;
  AlignedArray<float> values_;
  std::span<const double> weights_;
};

}  // namespace waymark::fastslam
