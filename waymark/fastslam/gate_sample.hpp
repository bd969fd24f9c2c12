#pragma once

#include <array>

#include <Eigen/Core>

#include "waymark/core/aligned_array.hpp"
#include "waymark/fastslam/particles.hpp"
#include "waymark/kernels/particle_sightings.hpp"

namespace waymark::fastslam {

/// Mean and covariance of an innovation over particles: (range, bearing), or in the first component what
/// alone was measured. Not finite if any particle's is not.
struct InnovationMoments {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

/// A part of the particles, large enough to tell what the whole set expects to see: the first 1024 at most.
class GateSample {
 public:
  explicit GateSample(int capacity);

  /// The particles as they are now, positions counted from `origin_m`. They must stay until compare().
  void load(const Particles& particles, const Eigen::Vector2d& origin_m);

  /// How a sighting compares with what the loaded particles expect when all make the same increment, which is
  /// still to be drawn: the moments of the mixture of the particles' Gaussians.
  [[nodiscard]] InnovationMoments compare(const kernels::Sighting& sighting,
                                          const kernels::Increment& increment);

 private:
  [[nodiscard]] kernels::PoseColumns columns(std::size_t begin);

  std::size_t stride_;
  AlignedArray<float> values_;
  std::span<const double> weights_;
};

}  // namespace waymark::fastslam
