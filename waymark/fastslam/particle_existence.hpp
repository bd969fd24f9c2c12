#pragma once

#include <vector>

#include "waymark/association/association_options.hpp"
#include "waymark/core/aligned_array.hpp"
#include "waymark/fastslam/belief.hpp"
#include "waymark/fastslam/particle_matcher.hpp"
#include "waymark/fastslam/scan.hpp"
#include "waymark/fastslam/sensor_model.hpp"

namespace waymark::fastslam {

/// The existence of a landmark over all particles.
struct Support {
  double present = 0.0;      ///< weight of the particles whose map has it: log-odds >= 0
  double confirmed = 0.0;    ///< weight of those whose log-odds are at least `confirmed`
  double probability = 0.0;  ///< existence probability: `present`, times that of the mean log-odds of those
};

/// Of a column of log-odds, one per particle. O(N).
[[nodiscard]] Support support(const float* log_odds, double confirmed, const Particles& particles,
                              ParticleBlocks& blocks);

/// Track management of landmarks of unknown identity. Every particle has log-odds of the existence of each
/// (AssociationModel); a landmark whose log-odds are below 0 is no longer in the particle's map.
class ParticleExistence {
 public:
  ParticleExistence(const AssociationModel& model, const SensorModel& sensor, const ParticleBlocks& blocks);

  /// After the update by a scan: the log-odds of landmarks that were observed rise, those of landmarks that
  /// should have been observed fall. Sets ParticleRecord::existence_probability, to 0 if particles of less
  /// than 1 % of the weight have the landmark, and confirms landmarks that particles of more than half of the
  /// weight are sure of. Landmarks are in reach if the sensor may see them from within the ellipse of the
  /// pose, whose squared Mahalanobis distance is `reach`. O(N landmarks in reach).
  void update(const Scan& scan, const ParticleMatcher& matcher, double reach, Belief& belief);

 private:
  void find_landmarks_in_reach(const ParticleMatcher& matcher, double reach, const Belief& belief);
  void update_chosen(const ParticleMatcher& matcher, Belief& belief);
  void update_observed(int landmark, Belief& belief);
  void update_observed_by(const float* takers, int landmark, Belief& belief);
  void record_support(int landmark, Belief& belief) const;

  AssociationModel model_;
  LandmarkSensor sensor_;
  kernels::SensorView view_;
  AlignedArray<float> nobody_;  // zeros
  std::vector<int> in_reach_;   // landmarks in doubt that this scan may have shown
};

}  // namespace waymark::fastslam
