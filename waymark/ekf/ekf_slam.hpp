#pragma once

#include <optional>
#include <vector>

#include "waymark/association/association_options.hpp"
#include "waymark/association/fault_isolation.hpp"
#include "waymark/association/gate.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/function_blocks.hpp"
#include "waymark/ekf/compressed_state.hpp"
#include "waymark/ekf/deferred_initialiser.hpp"
#include "waymark/ekf/ekf_options.hpp"
#include "waymark/ekf/iterated_update.hpp"
#include "waymark/ekf/nearby_landmarks.hpp"
#include "waymark/ekf/odometry_states.hpp"
#include "waymark/ekf/point_map.hpp"
#include "waymark/ekf/point_observation.hpp"
#include "waymark/ekf/sensor_bias_states.hpp"
#include "waymark/ekf/unknown_matcher.hpp"
#include "waymark/models/completed_observations.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark {

/// EKF-SLAM (Vincke et al. 2012 \cite vincke2012) over range-bearing observations of 2-D landmarks, gated one
/// by one; a first observation adds its landmark, in the place of the least useful one when the map is full.
///
/// Ranges alone or bearings alone need identities. Such a landmark is added only once several views leave
/// a single position for it (deferred initialisation); then all of them correct it at once. Until then
/// the positions of its views are in the state, one or two points of the capacity each.
///
/// Observations of unknown identity are not used, or, with EkfOptions::unknown, matched with the
/// likeliest landmarks. An unmatched one starts a landmark if it is outside the gates of all landmarks
/// even after the others have corrected the state; otherwise it is ambiguous and not used. The new
/// landmark is tentative, in the state but not in the map, until its existence is confirmed; false tracks
/// are removed, and two landmarks that turn out to be the same are merged.
class EkfSlam final : public Filter {
 public:
  /// Of `sensor` it takes where it sits, its biases, and its noise where an observation brings no
  /// covariance; with EkfOptions::unknown also its limits. `threads` share updates of large maps; the result
  /// does not depend on them. Takes all its memory here. One object must not be used by two threads at once;
  /// two objects may.
  EkfSlam(const EkfOptions& options, const LandmarkSensor& sensor, int threads = 1);

  /// Starts from a saved map of 2-D landmarks, no more than `options.loaded`, with all its correlations; only
  /// before anything else. Changes nothing where it does not fit. The biases of the sensor begin
  /// anew. What a map says is there is taken to be there: a landmark without identity is neither tentative
  /// nor forgotten.
  [[nodiscard]] Result<void> load(const MapState& map) { return map_.load(map); }

  /// From now on the landmarks stay as they are and no others are added: what they are unsure of is
  /// considered (Schmidt 1966 \cite schmidt1966), and only the pose and the sensor's biases are
  /// estimated.
  void hold_landmarks();

  /// Puts the robot somewhere else, as sure of it as the covariance says.
  void place_robot(const PoseEstimate& pose);

  void predict(const Motion& motion) override;
  const Correction& correct(std::span<const Observation> observations) override;
  [[nodiscard]] PoseEstimate pose() const override { return state().active().pose(); }
  [[nodiscard]] FilterHealth health() const override { return faults_.health(); }
  [[nodiscard]] Snapshot snapshot() const override { return map_.snapshot(); }
  [[nodiscard]] MapState save() const override { return map_.save(); }
  [[nodiscard]] const FunctionBlocks& blocks() const override { return blocks_; }
  [[nodiscard]] std::optional<CalibrationEstimate> calibration() const override;

  [[nodiscard]] const ekf::CompressedState& state() const { return map_.state(); }
  /// Pairs of landmarks that turned out to be one.
  [[nodiscard]] int merges() const { return merges_; }

 private:
  /// What only observations without identity need.
  struct Unknown {
    Unknown(const UnknownAssociation& association, const GateOptions& gate, const LandmarkSensor& sensor,
            ekf::PointMap& map, const ekf::PointObservation& observation);

    LandmarkSensor sensor;
    AssociationModel model;
    ekf::NearbyLandmarks nearby;
    ekf::UnknownMatcher matcher;
  };

  void begin_scan(std::size_t count);
  void associate(std::size_t index, const Observation& observation);
  void associate_unknown(std::span<const Observation> observations);
  void gate(Innovation& innovation, const std::optional<ekf::LinearizedObservation>& linearization);
  void gate_again(const Motion& added_motion, std::span<const Observation> observations);
  void isolate_faults(std::span<const Observation> observations);
  void update(std::span<const Observation> observations);
  void collect(std::size_t index, const Observation& observation);
  void classify_unmatched(std::span<const Observation> observations);
  void judge_landmarks();
  void begin_anew_where_wrong(std::size_t index);
  void add(std::size_t index, const Observation& observation);
  [[nodiscard]] std::optional<ekf::LinearizedObservation> linearize(std::size_t index,
                                                                    const Observation& observation) const;
  [[nodiscard]] bool already_seen(std::size_t index, LandmarkId id) const;
  [[nodiscard]] Outcome of_no_landmark() const { return held_ ? Outcome::kNotInMap : Outcome::kAdded; }

  ekf::SensorBiasStates errors_;
  ekf::OdometryStates odometry_;
  ekf::PointMap map_;
  ekf::PointObservation observation_;
  CompletedObservations completed_;
  Gate gate_;
  FaultIsolation faults_;
  ekf::IteratedUpdate iterated_;
  ekf::DeferredInitialiser deferred_;
  std::optional<Unknown> unknown_;
  bool held_ = false;  // nothing is added
  int merges_ = 0;
  std::vector<Innovation> innovations_;            // one per observation of the last correct()
  std::vector<int> matched_;                       // the same: index of its landmark, or -1
  std::vector<ekf::LinearizedObservation> block_;  // of one update
  std::vector<std::size_t> seen_;                  // their observations
  Correction correction_;
  FunctionBlocks blocks_{"FB1 predict", "FB3 associate", "FB6 estimate", "FB9 add"};
};

}  // namespace waymark
