#pragma once

#include <array>
#include <cstddef>

#include "waymark/kernels/particle_columns.hpp"

/// What one sighting of one landmark does to particles. Columns of poses, increments and weights begin at the
/// first particle of the range, columns of landmarks at particle 0.
namespace waymark::kernels {

/// Particles [begin, begin + count); `begin` is a multiple of kParticleLanes.
struct ParticleRange {
  std::size_t begin = 0;
  std::size_t count = 0;
};

/// What was seen, from where, and which landmark it is.
struct Sighting {
  SeenLandmark seen;
  SensorMount mount;
  LandmarkView landmark;
};

/// sum w (1, nu_r, nu_b, P_rr, P_rb, P_bb) over particles and hypotheses of weight w: nu the innovation less
/// `about`, P = L + nu nu^T its second moment, with L = Hx P Hx^T + Hm Sigma Hm^T + R. A range alone fills
/// the components r, a bearing alone the components b. Innovations of bearings are within half a turn of
/// `about`.
using InnovationSums = std::array<double, 6>;

struct About {
  float range = 0.0F;
  float bearing = 0.0F;
};

/// How the sighting compares with what is expected when every robot makes the same increment.
InnovationSums compare_sighting(const Sighting& sighting, const Increment& increment,
                                const PoseColumns& before, const About& about, const double* weight,
                                ParticleRange range);

/// What the sighting tells of the increments of robots that stood at `before` (Montemerlo et al. 2003): with
/// nu, L as above, mu += K nu, P -= K L K^T, K = P Hx^T L^-1, and log_weight += evidence log N(nu; 0, L) but
/// for its constant. Not for landmarks of several hypotheses.
void condition_increments(const Sighting& sighting, const PoseColumns& before, double evidence,
                          const IncrementColumns& increments, double* log_weight, ParticleRange range);

/// The EKF update of the landmark (Montemerlo et al. 2002) seen from `sensors` (their headings the robots'),
/// and log_weight += evidence log N(nu; 0, Z) but for its constant, Z = Hm Sigma Hm^T + R; `log_weight` may
/// be null. Of several hypotheses each is updated and weighed by its likelihood, and by whether it lies in
/// the field of view; the particle's likelihood is their weighted sum. Hypotheses below 1e-3 of the best are
/// dropped.
void update_landmark(const Sighting& sighting, const PoseColumns& sensors, double evidence,
                     double* log_weight, ParticleRange range);

/// How a landmark that is seen for the first time is set up, beside what was measured.
struct FirstGuess {
  float rho = 0.0F;          ///< kRay: mean inverse distance, 1/m
  float rho_var = 0.0F;      ///< and its variance
  float phi_spacing = 0.0F;  ///< kRing: angle between hypotheses, which lie symmetric to the sensor's axis
  float phi_var = 0.0F;      ///< and the variance of each
};

/// The landmark as it is after one sighting from `sensors`: for a known pose, Sigma = Hm^-1 R Hm^-T.
void place_landmark(const Sighting& sighting, const FirstGuess& guess, const PoseColumns& sensors,
                    ParticleRange range);

namespace reference {
InnovationSums compare_sighting(const Sighting& sighting, const Increment& increment,
                                const PoseColumns& before, const About& about, const double* weight,
                                ParticleRange range);
void condition_increments(const Sighting& sighting, const PoseColumns& before, double evidence,
                          const IncrementColumns& increments, double* log_weight, ParticleRange range);
void update_landmark(const Sighting& sighting, const PoseColumns& sensors, double evidence,
                     double* log_weight, ParticleRange range);
void place_landmark(const Sighting& sighting, const FirstGuess& guess, const PoseColumns& sensors,
                    ParticleRange range);
}  // namespace reference
}  // namespace waymark::kernels
