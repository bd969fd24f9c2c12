#pragma once

#include <cstdint>
#include <span>

#include "waymark/core/aligned_array.hpp"
#include "waymark/fastslam/particle_blocks.hpp"
#include "waymark/kernels/particle_columns.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark::fastslam {

/// Mean and standard deviation of what particles hold.
struct Spread {
  double mean = 0.0;
  double sigma = 0.0;
};

/// Scale and offset that all ranges have in common, each particle with its own: reported = scale * range +
/// offset. Drawn once; what the observations say of them, resampling and moves tell.
class RangeCalibration {
 public:
  /// One for `blocks`, which must outlive it, drawn as unsure as the sensor's shared errors of range; without
  /// any nothing is estimated.
  RangeCalibration(const LandmarkSensor& sensor, std::uint64_t seed, ParticleBlocks& blocks);

  [[nodiscard]] bool is_estimated() const { return scale_.size() > 0; }
  /// Null columns where nothing is estimated.
  [[nodiscard]] kernels::RangeErrors columns() const;

  /// Per particle, to be moved; then refresh() takes the new scales over.
  [[nodiscard]] float* scale() { return scale_.data(); }
  [[nodiscard]] float* offset_m() { return offset_m_.data(); }
  void refresh();

  /// As Particles::replace_by_ancestors().
  void replace_by_ancestors(std::span<const std::int32_t> ancestors);

  [[nodiscard]] Spread scale(std::span<const double> weights) const;
  [[nodiscard]] Spread offset_m(std::span<const double> weights) const;

 private:
  ParticleBlocks& blocks_;
  AlignedArray<float> scale_;
  AlignedArray<float> offset_m_;
  AlignedArray<float> factor_;  ///< 1 / scale
};

}  // namespace waymark::fastslam
