#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "waymark/association/association_options.hpp"
#include "waymark/association/gate.hpp"
#include "waymark/association/id_index.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/function_blocks.hpp"
#include "waymark/fastslam/association.hpp"
#include "waymark/fastslam/ensemble_move.hpp"
#include "waymark/fastslam/fast_slam_options.hpp"
#include "waymark/fastslam/gate_sample.hpp"
#include "waymark/fastslam/kld.hpp"
#include "waymark/fastslam/landmark_forms.hpp"
#include "waymark/fastslam/landmark_store.hpp"
#include "waymark/fastslam/particle_step.hpp"
#include "waymark/fastslam/particles.hpp"
#include "waymark/fastslam/resampling.hpp"
#include "waymark/fastslam/view_history.hpp"
#include "waymark/models/completed_observations.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark {

/// FastSLAM 1.0 and 2.0 (Montemerlo et al. 2002, 2003 \cite montemerlo2002 \cite montemerlo2003) over
/// sightings of 2-D landmarks, with identities or without, by range and bearing, range alone or bearing
/// alone. Motion is collected until something is seen, then every particle draws from it. docs/fastslam.md
/// has the equations.
///
/// Given a particle's path the pose of a first sighting is exactly known. So a landmark of which only the
/// bearing is known is kept as direction and inverse distance from there, one of which only the range is
/// known as hypotheses on a ring about there: each nearly linear, and of use from the first sighting on. They
/// turn into points when that is nearly linear too.
///
/// Robust where the plain filter starves:
/// * A sighting weighs particles by how much news it brings: with the power 1 - exp(-w / evidence_way_m) of
///   its likelihood, w the way since that landmark was last seen. A landmark under watch says little about
///   where the path as a whole went, and its errors are alike from frame to frame; weights that count every
///   frame in full make the set forget its own past by resampling long before a loop closes (Bailey, Nieto,
///   Nebot 2006 \cite bailey2006fastslam).
/// * An observation is gated by the whole set, not particle by particle. A set that refuses several in a row
///   is itself what is wrong, and has to accept again.
/// * Weights never collapse onto a few particles: they are flattened to keep `temper_below` effective.
/// * The pose and its covariance are taken after weighting and before resampling.
/// * A robot that stands still is neither predicted nor resampled.
class FastSlam final : public Filter {
 public:
  /// Of `sensor` it takes where it sits, its lasting errors, its limits, and its noise where an observation
  /// brings no covariance. `threads` share the particles. Takes memory for particles here, and for a landmark
  /// when it is added. One object must not be used by two threads at once; two objects may.
  FastSlam(const FastSlamOptions& options, const LandmarkSensor& sensor, int threads = 1);

  /// O(1); a motion that is not finite is ignored.
  void predict(const Motion& motion) override;
  const Correction& correct(std::span<const Observation> observations) override;
  [[nodiscard]] PoseEstimate pose() const override;
  [[nodiscard]] Snapshot snapshot() const override;
  [[nodiscard]] MapState save() const override;
  [[nodiscard]] const FunctionBlocks& blocks() const override { return table_; }

  [[nodiscard]] const fastslam::Particles& particles() const { return particles_; }
  /// What ranges have in common, as far as the sensor's shared errors say that there is anything to find out.
  [[nodiscard]] const fastslam::RangeCalibration& range_calibration() const { return calibration_; }
  /// How often the set was resampled.
  [[nodiscard]] std::int64_t resamplings() const { return resamplings_; }
  /// How often a sighting moved the particles instead of weighing them.
  [[nodiscard]] std::int64_t moves() const { return moves_; }
  /// How often the robot must have slipped far beyond its odometry: see correct().
  [[nodiscard]] std::int64_t slips() const { return slips_; }
  /// How many unnamed sightings the particles did not agree on.
  [[nodiscard]] std::int64_t splits() const { return splits_; }

 private:
  struct Landmark {
    LandmarkId id;
    int observations = 0;
    double seen_at_way_m = 0.0;
    std::int64_t seen_at_scan = 0;
    std::int64_t claimed_at_scan = 0;  // by a sighting, or decided about by each particle for itself
    std::int64_t claimed_before = 0;   // the scan of the claim before that
    double range_m = 0.0;              // when it was last seen by range alone, else 0
    bool confirmed = true;             // counts in the map
    double existence = 1.0;            // probability of it
  };

  /// A landmark that stood on an edge of the field of view, between two scans.
  struct EdgeSighting {
    int landmark = 0;
    kernels::SeenLandmark seen;
    kernels::SensorMount mount;
  };

  void associate(std::span<const Observation> observations);

  // Sightings without identity: fast_slam_unnamed.cpp.
  void match_unnamed(std::span<const Observation> observations);
  void decide(std::span<const Observation> observations);
  void find_candidates(const Observation& observation, int index, const Pose2& T_world_sensor);
  void take_decisions();
  [[nodiscard]] double candidate_radius_m(const Observation& observation) const;
  void settle_contested(std::span<const Observation> observations);
  void split(std::span<const Observation> observations);
  void offer_choices(const Observation& observation, int index);
  void list_likelihoods(const Observation& observation, int landmark, float* column);
  void accept_choices(std::span<const Observation> observations);
  [[nodiscard]] double split_evidence(int index) const;
  void report_choice(const fastslam::Association::Choice& choice);
  void update_existence();
  void note_choices();
  void find_landmarks_in_reach();
  void note_sighting(int landmark, const float* takers);
  void note_support(int landmark);
  void forget_ghosts();
  void forget(int landmark);
  void add_choices(std::span<const Observation> observations);
  LandmarkId add_unnamed(const Observation& observation);
  [[nodiscard]] bool any_contested() const;

  void take_match(std::size_t index, int landmark);
  [[nodiscard]] Outcome screen(std::size_t index, const Observation& observation) const;
  void compare(std::span<const Observation> observations);
  void judge(const Observation& observation, std::size_t index);
  [[nodiscard]] fastslam::InnovationMoments compare(const Observation& observation, int landmark);
  [[nodiscard]] bool is_lost();
  [[nodiscard]] bool mostly_gated() const;
  void widen(std::span<const Observation> observations);
  void accept(const kernels::Sighting& sighting, int landmark, double news,
              const fastslam::InnovationMoments& moments);
  [[nodiscard]] bool move_by(const kernels::Sighting& sighting, double news,
                             fastslam::InnovationMoments moments);
  void find_edges(std::span<const Observation> observations);
  void add_edge(int landmark, double range_m, std::size_t age);
  void accept(const EdgeSighting& edge);
  void move_particles();
  void accept(const Observation& observation, int landmark, const fastslam::InnovationMoments& moments);
  void count_sighting(int landmark);
  void weigh();
  void miss();
  void miss(int landmark);
  void refine();
  void resample();
  [[nodiscard]] std::size_t next_count();
  void add(std::span<const Observation> observations);
  void place(int landmark, const kernels::SeenLandmark& seen, const kernels::FirstGuess& guess);

  [[nodiscard]] kernels::Sighting sighting(const Observation& observation, int landmark) const;
  [[nodiscard]] kernels::SeenLandmark seen(const Observation& observation, double way_since_m) const;
  [[nodiscard]] double way_since_m(int landmark) const;
  [[nodiscard]] double news(int landmark) const;
  [[nodiscard]] bool any(Outcome outcome) const;
  [[nodiscard]] LandmarkEstimate landmark(int index) const;
  [[nodiscard]] std::vector<int> confirmed() const;
  [[nodiscard]] Eigen::MatrixXd joint_covariance(const Pose2& T_world_robot, const std::vector<int>& indices,
                                                 const Eigen::VectorXd& landmarks) const;

  CompletedObservations completed_;
  FastSlamOptions options_;
  Gate gate_;
  LandmarkSensor sensor_;
  kernels::SensorMount mount_;
  std::uint64_t seed_;

  fastslam::ParticleBlocks particle_blocks_;
  fastslam::Particles particles_;
  fastslam::RangeCalibration calibration_;
  fastslam::LandmarkStore store_;
  fastslam::GateSample gate_sample_;
  fastslam::EnsembleMove move_;
  fastslam::ViewHistory history_;
  std::size_t edge_scans_;
  std::vector<EdgeSighting> edges_;
  std::vector<fastslam::AcceptedSighting> accepted_;
  fastslam::Resampling resampling_;
  fastslam::OccupiedBins bins_;
  IdIndex index_;
  std::vector<Landmark> landmarks_;  // by index in the store
  std::vector<int> unresolved_;      // rays and rings
  std::optional<fastslam::Association> association_;
  kernels::View view_;
  std::vector<int> matched_;     // landmark of each observation that is matched
  std::vector<char> contested_;  // observations that the set has not decided on
  std::vector<char> undecided_;  // contested when particles were first asked
  AlignedArray<float> nobody_;   // zeros
  std::vector<int> in_reach_;    // landmarks that this scan may have shown
  std::vector<LandmarkId> removed_;
  std::int32_t next_unnamed_ = 0;
  std::int64_t splits_ = 0;

  PoseEstimate estimate_;  // of the particles, after weighting and before resampling
  Motion pending_;         // since the particles were last moved
  bool moved_ = false;     // since the last correct()
  double way_m_ = 0.0;     // driven so far, turns included
  std::uint64_t step_ = 0;
  std::int64_t scan_ = 0;
  std::int64_t resamplings_ = 0;
  int gated_in_a_row_ = 0;
  std::int64_t slips_ = 0;
  std::int64_t moves_ = 0;

  std::vector<Innovation> innovations_;
  std::vector<fastslam::InnovationMoments> moments_;  // of the matched ones, beside innovations_
  Correction correction_;
  FunctionBlocks table_{"associate", "compare", "update", "estimate", "resample", "add"};
};

}  // namespace waymark
