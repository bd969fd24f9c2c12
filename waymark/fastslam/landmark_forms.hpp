#pragma once

#include <cstddef>

#include "waymark/fastslam/landmark_store.hpp"
#include "waymark/fastslam/particle_blocks.hpp"
#include "waymark/fastslam/particles.hpp"
#include "waymark/fastslam/view_history.hpp"
#include "waymark/kernels/particle_observations.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark::fastslam {

/// How a landmark begins.
struct FirstForm {
  kernels::LandmarkForm form = kernels::LandmarkForm::kPoint;
  std::size_t modes = 1;
  kernels::FirstGuess guess;
};

/// A bearing begins as a ray with hypotheses at distances in a geometric series within the sensor's limits
/// (Sola et al. 2005); a range as a ring of hypotheses over its field of view, so many that each stays nearly
/// linear while the robot moves as far as the landmark is away: b sigma_phi^2 / 2 < 0.3 sigma_r (after Blanco
/// et al. 2008 and Djugash and Singh 2008). Only where it can have been out of view until now.
[[nodiscard]] FirstForm first_form(const kernels::LandmarkMeasurement& seen, const LandmarkSensor& sensor,
                                   const ViewHistory& history);

/// Whether a landmark of such a form can be updated by such an observation.
[[nodiscard]] bool can_take(kernels::LandmarkForm form, kernels::ObservationKind kind);

/// Hypotheses that have come together become one, those that no particle has any more are forgotten, and when
/// hardly any particle has more than one left, each keeps its best.
void tidy_modes(LandmarkStore& store, int landmark, const Particles& particles, ParticleBlocks& blocks);

/// Turns a ray or a ring of one hypothesis into a point if that is nearly linear for hardly any exception: a
/// ring when sigma_phi < 0.1, a ray when L = 4 sigma_d |cos alpha| / d < 0.1 with sigma_d = sigma_rho /
/// rho^2, alpha the parallax and d the distance from the sensor (Civera, Davison, Montiel 2008).
void become_point_if_linear(LandmarkStore& store, int landmark, const Particles& particles,
                            const kernels::SensorMount& mount, ParticleBlocks& blocks);

}  // namespace waymark::fastslam
