#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "waymark/association/fault_isolation.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/function_blocks.hpp"
#include "waymark/fastslam/adaptive_resampling.hpp"
#include "waymark/fastslam/belief.hpp"
#include "waymark/fastslam/fast_slam_options.hpp"
#include "waymark/fastslam/innovation_gate.hpp"
#include "waymark/fastslam/map_management.hpp"
#include "waymark/fastslam/particle_existence.hpp"
#include "waymark/fastslam/particle_matcher.hpp"
#include "waymark/fastslam/scan.hpp"
#include "waymark/fastslam/scan_update.hpp"
#include "waymark/fastslam/sensor_model.hpp"
#include "waymark/fastslam/view_edges.hpp"
#include "waymark/fastslam/view_history.hpp"
#include "waymark/models/completed_observations.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark {

/// FastSLAM 1.0 and 2.0 (Montemerlo et al. 2002, 2003 \cite montemerlo2002 \cite montemerlo2003) over
/// observations of 2-D landmarks of known or unknown identity, by range and bearing, range alone or
/// bearing alone. Motion is accumulated until the next observation; then every particle draws a pose from
/// it. docs/fastslam.md has the equations.
///
/// Given a particle's path the pose of a first observation is exactly known. So a landmark of which only the
/// bearing is known is kept as direction and inverse distance from there, one of which only the range is
/// known as hypotheses on a ring about there: each nearly linear, and of use from the first observation on.
/// They turn into points when that is nearly linear too.
///
/// Robust where the plain filter starves:
/// * An observation weighs particles by how much information it brings (fastslam::InformationWeight), or
///   moves them instead (fastslam::ScanUpdate).
/// * An observation is gated by the whole set, not particle by particle (fastslam::InnovationGate). Whether
/// the
///   robot or a landmark is to blame for those that are is what FaultIsolation tells.
/// * Weights never collapse onto a few particles (fastslam::AdaptiveResampling).
/// * The pose and its covariance are taken after weighting and before resampling.
/// * A robot that stands still is neither predicted nor resampled.
class FastSlam final : public Filter {
 public:
  /// Of `sensor` it takes where it sits, its biases, its limits, and its noise where an observation
  /// brings no covariance. `threads` share the particles. Takes memory for particles here, and for a landmark
  /// when it is added. One object must not be used by two threads at once; two objects may.
  FastSlam(const FastSlamOptions& options, const LandmarkSensor& sensor, int threads = 1);

  /// O(1); a motion that is not finite is ignored.
  void predict(const Motion& motion) override;
  const Correction& correct(std::span<const Observation> observations) override;
  [[nodiscard]] PoseEstimate pose() const override { return belief_.pose(); }
  [[nodiscard]] FilterHealth health() const override { return faults_.health(); }
  [[nodiscard]] Snapshot snapshot() const override;
  [[nodiscard]] MapState save() const override;
  [[nodiscard]] const FunctionBlocks& blocks() const override { return blocks_; }

  [[nodiscard]] const fastslam::Particles& particles() const { return belief_.particles; }
  /// What ranges have in common, as far as the sensor's shared errors say that there is anything to find out.
  [[nodiscard]] const fastslam::RangeCalibration& range_calibration() const { return belief_.calibration; }
  /// How often the set was resampled.
  [[nodiscard]] std::int64_t resamplings() const { return resampling_.resamplings(); }
  /// How many observations of unknown identity the particles did not agree on.
  [[nodiscard]] std::int64_t splits() const { return unknown_ ? unknown_->matcher.splits() : 0; }

 private:
  /// What only observations without identity need.
  struct Unknown {
    Unknown(const AssociationOptions& options, const fastslam::SensorModel& model,
            fastslam::ParticleBlocks& blocks);
    fastslam::ParticleMatcher matcher;
    fastslam::ParticleExistence existence;
  };

  void associate();
  [[nodiscard]] Outcome identify(std::size_t index) const;
  [[nodiscard]] int room() const;
  [[nodiscard]] bool is_ambiguous(std::size_t index) const;
  [[nodiscard]] bool tells_nothing() const;
  void gate();
  void isolate_faults();
  void begin_anew_where_wrong(std::size_t index);
  void accept();
  void accept(std::size_t index);
  void accept(const fastslam::ViewEdge& edge);
  void resolve_ambiguous();
  void weigh();
  void manage_map();
  void initialise();

  CompletedObservations completed_;
  fastslam::SensorModel model_;
  fastslam::Belief belief_;
  fastslam::Scan scan_;
  fastslam::ViewHistory history_;
  fastslam::InnovationGate gate_;
  FaultIsolation faults_;
  fastslam::ScanUpdate update_;
  fastslam::ViewEdges edges_;
  fastslam::AdaptiveResampling resampling_;
  fastslam::MapManagement map_;
  std::optional<Unknown> unknown_;
  Correction correction_;
  FunctionBlocks blocks_{"associate", "compare", "update", "estimate", "resample", "add"};
};

}  // namespace waymark
