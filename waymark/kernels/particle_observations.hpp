#pragma once

#include <array>
#include <cstddef>

#include "waymark/kernels/particle_columns.hpp"

/// What one observation of one landmark does to particles. Columns of poses, increments and weights begin at
/// the first particle of the range, columns of landmarks at particle 0.
namespace waymark::kernels {

/// Particles [begin, begin + count); `begin` is a multiple of kParticleLanes.
struct ParticleRange {
  std::size_t begin = 0;
  std::size_t count = 0;
};

/// What was seen, from where, and which landmark it is.
struct LandmarkObservation {
  LandmarkMeasurement seen;
  SensorMount mount;
  LandmarkView landmark;
};

/// Sums over particles and hypotheses of weight w: of w, of w nu, of w nu nu^T and of w L, matrices as (rr,
/// rb, bb). nu is the innovation less `about`, and within half a turn of it, L = Hx P Hx^T + Hm Sigma Hm^T +
/// R its covariance. A range alone fills the components r, a bearing alone the components b.
struct InnovationSums {
  double w = 0.0;
  std::array<double, 2> nu{};
  std::array<double, 3> nu_nu{};
  std::array<double, 3> L{};
};

struct About {
  float range = 0.0F;
  float bearing = 0.0F;
};

/// How the observation compares with what is expected of robots that stood at `before` and then moved by the
/// increment.
InnovationSums compare_observation(const LandmarkObservation& observation, const Increment& increment,
                                   const PoseColumns& before, const About& about, const double* weight,
                                   ParticleRange range);

/// The innovations of each particle, less `about`: of range and of bearing, 0 where it is not measured. Of
/// several hypotheses the weighted mean; those of a weight below 1e-3 do not count.
void list_innovations(const LandmarkObservation& observation, const Increment& increment,
                      const PoseColumns& before, const About& about, float* nu_r, float* nu_b,
                      ParticleRange range);

/// What the observation tells of the increments of robots that stood at `before` (Montemerlo et al. 2003):
/// with nu, L as above, mu += K nu, P -= K L K^T, K = P Hx^T L^-1, and log_weight += exponent log N(nu; 0, L)
/// but for its constant. Several hypotheses count as one Gaussian with the moments of their mixture.
void condition_increments(const LandmarkObservation& observation, const Increment& expected,
                          const PoseColumns& before, double exponent, const IncrementColumns& increments,
                          double* log_weight, ParticleRange range);

/// The EKF update of the landmark (Montemerlo et al. 2002) seen from `sensors` (their headings the robots'),
/// and log_weight += exponent log N(nu; 0, Z) but for its constant, Z = Hm Sigma Hm^T + R; `log_weight` may
/// be null. Of several hypotheses each is updated and weighed by its likelihood, and by whether it lies in
/// the field of view; the particle's likelihood is their weighted sum. Hypotheses below 1e-3 of the best are
/// dropped.
void update_landmark(const LandmarkObservation& observation, const PoseColumns& sensors, double exponent,
                     double* log_weight, ParticleRange range);

/// A hypothesis of what the first observation of a landmark does not measure.
struct FirstMode {
  float value = 0.0F;  ///< kRay: inverse distance, 1/m; kRing: direction, left of the sensor's axis
  float variance = 0.0F;
  float log_weight = 0.0F;
};

/// How a landmark that is seen for the first time is set up, beside what was measured: a mode for each of its
/// hypotheses. Nothing for points.
struct FirstGuess {
  std::array<FirstMode, kMaxModes> modes{};
};

/// Of a landmark of several hypotheses that was not seen, those that are clearly in view keep 1 - detected of
/// their weight. Dropped as in update_landmark.
void miss_modes(const LandmarkObservation& observation, double detected, const PoseColumns& sensors,
                ParticleRange range);

/// The landmark as it is after one observation from `sensors`: for a known pose, Sigma = Hm^-1 R Hm^-T.
void place_landmark(const LandmarkObservation& observation, const FirstGuess& guess,
                    const PoseColumns& sensors, ParticleRange range);

namespace reference {
InnovationSums compare_observation(const LandmarkObservation& observation, const Increment& increment,
                                   const PoseColumns& before, const About& about, const double* weight,
                                   ParticleRange range);
void list_innovations(const LandmarkObservation& observation, const Increment& increment,
                      const PoseColumns& before, const About& about, float* nu_r, float* nu_b,
                      ParticleRange range);
void condition_increments(const LandmarkObservation& observation, const Increment& expected,
                          const PoseColumns& before, double exponent, const IncrementColumns& increments,
                          double* log_weight, ParticleRange range);
void update_landmark(const LandmarkObservation& observation, const PoseColumns& sensors, double exponent,
                     double* log_weight, ParticleRange range);
void miss_modes(const LandmarkObservation& observation, double detected, const PoseColumns& sensors,
                ParticleRange range);
void place_landmark(const LandmarkObservation& observation, const FirstGuess& guess,
                    const PoseColumns& sensors, ParticleRange range);
}  // namespace reference
}  // namespace waymark::kernels
