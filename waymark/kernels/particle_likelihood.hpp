#pragma once

#include "waymark/kernels/particle_columns.hpp"
#include "waymark/kernels/particle_observations.hpp"

namespace waymark::kernels {

/// log N(nu; 0, L) of each particle, per metre and radian: how likely an observation by range and bearing of
/// a landmark that is a point is for robots that stood at `before` and then moved by the increment. nu and L
/// as in compare_observation(). `log_likelihood` begins at the first particle of the range.
void list_log_likelihoods(const LandmarkObservation& observation, const Increment& increment,
                          const PoseColumns& before, float* log_likelihood, ParticleRange range);

namespace reference {
void list_log_likelihoods(const LandmarkObservation& observation, const Increment& increment,
                          const PoseColumns& before, float* log_likelihood, ParticleRange range);
}  // namespace reference
}  // namespace waymark::kernels
