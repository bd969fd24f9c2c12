#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "waymark/association/association_options.hpp"
#include "waymark/fastslam/association.hpp"
#include "waymark/fastslam/belief.hpp"
#include "waymark/fastslam/innovation_gate.hpp"
#include "waymark/fastslam/scan.hpp"
#include "waymark/fastslam/scan_update.hpp"
#include "waymark/fastslam/sensor_model.hpp"

namespace waymark::fastslam {

/// Matches the observations of a scan that have no identity. The set decides what it can, once before and
/// once after clear observations have moved it; what it cannot is ambiguous, and then each particle decides
/// for itself. See Association for the scheme.
class ParticleMatcher {
 public:
  /// `blocks` must outlive it.
  ParticleMatcher(const AssociationModel& model, const SensorModel& sensor, ParticleBlocks& blocks);

  /// The first decision of the set, about observations by range and bearing that are unidentified so far: of
  /// landmarks that nothing else claimed, or of one of the `room` new ones that the map can hold.
  void match(Scan& scan, const InnovationGate& gate, int room, Belief& belief);

  /// The second decision, about what is ambiguous. Which observations it matched, in their order, not yet
  /// gated; valid until the next decision. Needs Belief::load_sample().
  [[nodiscard]] std::span<const std::size_t> match_ambiguous(Scan& scan, const InnovationGate& gate, int room,
                                                             Belief& belief);

  /// Each particle decides about what is ambiguous still. Its weight takes the score of what it chose, and
  /// the update what it is to take in. The scan is told the choice of the majority.
  void split(Scan& scan, ScanUpdate& update, Belief& belief);

  [[nodiscard]] bool is_ambiguous(std::size_t index) const { return ambiguous_[index] != 0; }
  [[nodiscard]] bool any_ambiguous() const;
  /// Between which the particles split in this scan.
  [[nodiscard]] std::span<const Association::Choice> choices() const { return association_.choices(); }

  /// Calls visit(landmark) for landmarks within a radius, as they were when the scan was matched.
  template <class Visit>
  void visit_near(const Eigen::Vector2d& p_world, double radius_m, const Visit& visit) const {
    association_.visit_near(p_world, radius_m, visit);
  }

  /// How many observations the particles did not agree on.
  [[nodiscard]] std::int64_t splits() const { return splits_; }

 private:
  void decide(Scan& scan, const InnovationGate& gate, int room, Belief& belief);
  void find_candidates(std::size_t index, const Scan& scan, const InnovationGate& gate,
                       const Pose2& T_world_sensor, Belief& belief);
  void take_decisions(Scan& scan, int room, Belief& belief);
  void offer_choices(std::size_t index, const Scan& scan, Belief& belief);
  void list_likelihoods(const kernels::LandmarkObservation& landmark_observation, float* column,
                        Belief& belief) const;
  void accept_choices(const Scan& scan, ScanUpdate& update, Belief& belief) const;
  [[nodiscard]] double power(int observation, const ScanUpdate& update, const Belief& belief) const;

  Association association_;
  SensorModel model_;
  std::vector<char> ambiguous_;       // observations that the set has not decided on
  std::vector<std::size_t> matched_;  // by the last decision
  std::int64_t splits_ = 0;
};

}  // namespace waymark::fastslam
