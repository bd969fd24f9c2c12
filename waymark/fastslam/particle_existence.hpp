#pragma once

#include <vector>

#include "waymark/association/association_options.hpp"
#include "waymark/core/aligned_array.hpp"
#include "waymark/fastslam/belief.hpp"
#include "waymark/fastslam/particle_matcher.hpp"
#include "waymark/fastslam/scan.hpp"
#include "waymark/fastslam/sensor_model.hpp"

namespace waymark::fastslam {

/// What the particles together hold of a landmark's existence.
struct Support {
  double present = 0.0;      ///< weight of the particles that have it
  double confirmed = 0.0;    ///< weight of those that are sure of it
  double probability = 0.0;  ///< that it exists
};

/// Of a column of log-odds, one per particle; sure from `confirmed` on. O(N).
[[nodiscard]] Support support(const float* log_odds, double confirmed, const Particles& particles,
                              ParticleBlocks& blocks);

/// Judges which landmarks exist that were met without identity: each particle has log-odds of each
/// (AssociationModel), and below 0 it does not have the landmark any more.
class ParticleExistence {
 public:
  ParticleExistence(const AssociationModel& model, const SensorModel& sensor, const ParticleBlocks& blocks);

  /// After the particles have taken the scan in: landmarks that were seen are surer, those that should have
  /// been are less so. The landmark table takes the probability that each exists, 0 if particles of hardly
  /// any weight have it, and confirms what most of the weight is sure of. `reach` is the gate's threshold for
  /// how far off the robot may be. O(N landmarks in reach).
  void update(const Scan& scan, const ParticleMatcher& matcher, double reach, Belief& belief);

 private:
  void find_landmarks_in_reach(const ParticleMatcher& matcher, double reach, const Belief& belief);
  void note_choices(const ParticleMatcher& matcher, Belief& belief);
  void note_observation(int landmark, const float* takers, Belief& belief);
  void note_support(int landmark, Belief& belief) const;

  AssociationModel model_;
  LandmarkSensor sensor_;
  kernels::SensorView view_;
  AlignedArray<float> nobody_;  // zeros
  std::vector<int> in_reach_;   // landmarks in doubt that this scan may have shown
};

}  // namespace waymark::fastslam
