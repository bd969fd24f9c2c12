#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/association/association_options.hpp"
#include "waymark/association/greedy_match.hpp"
#include "waymark/association/joint_compatibility.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/ekf/ekf_options.hpp"
#include "waymark/ekf/nearby_landmarks.hpp"
#include "waymark/ekf/point_map.hpp"
#include "waymark/ekf/point_observation.hpp"

namespace waymark::ekf {

/// An observation without identity and a landmark within its gate.
struct UnknownMatch {
  int observation = 0;  ///< of the scan
  double cost = 0.0;    ///< -2 log-likelihood, but for a constant
  LinearizedObservation linearization;
};

/// Finds which landmarks the observations without identity of one scan are of: all of them jointly
/// (JointCompatibility) or pair by pair (GreedyMatch). docs/association.md describes the score. Range and
/// bearing only. Memory is taken as scans grow and kept.
class UnknownMatcher {
 public:
  /// Bound to the map and to the sensor's model.
  UnknownMatcher(const UnknownAssociation& association, const GateOptions& gate,
                 const AssociationModel& model, PointMap& map, const PointObservation& sensor);

  /// Matches the observations that are kUnidentified in `innovations` with landmarks that are not claimed in
  /// this scan, one to one, in the order of the observations. Brings the landmarks in question into the
  /// the submap of a compressed map, 48 at most. The view is good until the next call. Cost: an innovation
  /// covariance per landmark within reach, and JointCompatibility's.
  [[nodiscard]] std::span<const UnknownMatch> match(std::span<const Observation> observations,
                                                    std::span<const Innovation> innovations,
                                                    const NearbyLandmarks& nearby);

  /// Whether an observation is within the gate of any landmark as the map is now.
  [[nodiscard]] bool is_near_a_landmark(const Observation& observation, const NearbyLandmarks& nearby) const;

 private:
  template <class Visit>
  void visit_gated(const Observation& observation, const NearbyLandmarks& nearby, const Visit& visit) const;
  [[nodiscard]] double reach_m(const Observation& observation) const;
  void find_candidates(int index, const Observation& observation, const NearbyLandmarks& nearby);
  [[nodiscard]] bool consider(int landmark);
  [[nodiscard]] double bonus(const UnknownMatch& candidate, const Observation& observation) const;
  void match_jointly(std::span<const Observation> observations);
  void match_greedily(std::span<const Observation> observations);
  template <class IsMatch>
  void keep(const IsMatch& is_match);

  PointMap& map_;
  const PointObservation& sensor_;
  AssociationModel model_;
  double gate_;
  bool jointly_;
  GreedyMatch greedy_;
  JointCompatibility joint_;
  std::vector<UnknownMatch> candidates_;  // in the order of the observations; then the matches
  std::vector<int> considered_;           // their landmarks
};

}  // namespace waymark::ekf
