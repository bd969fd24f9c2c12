#pragma once

#include "waymark/kernels/particle_columns.hpp"
#include "waymark/kernels/particle_observations.hpp"

/// Log-odds that a landmark exists, one per particle: kAbsent where a particle does not have it.
namespace waymark::kernels {

inline constexpr float kAbsent = -1e30F;

/// What a sensor sees for certain, and how unsure what it measures is.
struct SensorView {
  SensorMount mount;
  float min_range = 0.0F;
  float max_range = 0.0F;
  float range_var = 0.0F;
  float bearing_var = 0.0F;
};

/// Particles that expect a point landmark within the view, by three standard deviations of what they would
/// measure, add `change` to its log-odds; what falls below 0 is absent from then on. Columns of `sensors`
/// begin at the first particle of the range, those of the landmark and of the log-odds at particle 0.
void miss_landmark(const LandmarkView& landmark, const PoseColumns& sensors, const SensorView& view,
                   float change, float* log_odds, ParticleRange range);

namespace reference {
void miss_landmark(const LandmarkView& landmark, const PoseColumns& sensors, const SensorView& view,
                   float change, float* log_odds, ParticleRange range);
}  // namespace reference
}  // namespace waymark::kernels
