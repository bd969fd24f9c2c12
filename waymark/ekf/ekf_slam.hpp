#pragma once

#include <optional>
#include <vector>

#include "waymark/association/association_options.hpp"
#include "waymark/association/exclusive_match.hpp"
#include "waymark/association/existence.hpp"
#include "waymark/association/gate.hpp"
#include "waymark/association/grid_index.hpp"
#include "waymark/association/id_index.hpp"
#include "waymark/association/joint_match.hpp"
#include "waymark/association/recovery.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/function_blocks.hpp"
#include "waymark/ekf/compressed_state.hpp"
#include "waymark/ekf/ekf_options.hpp"
#include "waymark/ekf/lasting_errors.hpp"
#include "waymark/ekf/locate.hpp"
#include "waymark/ekf/map_management.hpp"
#include "waymark/ekf/odometry_states.hpp"
#include "waymark/models/completed_observations.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark {

/// With kAuto a map is compressed when it is six times a region: below that it costs more than it saves.
[[nodiscard]] ekf::Compression compression(const EkfOptions& options);

/// EKF-SLAM (Vincke et al. 2012 \cite vincke2012) over range-bearing sightings of 2-D landmarks, gated one by
/// one; a first sighting adds its landmark, in the place of the least useful one when the map is full.
///
/// Ranges alone, or bearings alone, need identities. A landmark that is seen so is not in the state before
/// several views of it, each with the place that it was seen from as points of the state, leave one position
/// for it; then all of them correct it at once. Until then it costs a point, or two, per view, out of the
/// capacity.
///
/// Sightings without identity are refused, or, with EkfOptions::unknown, matched with landmarks that are
/// likely. One that is left over begins a landmark if it is outside of the gates of all landmarks even after
/// the others have corrected the state; in between it is ambiguous and not used. A landmark that was begun so
/// is tentative, in the state but not in the map, until its Existence is confirmed; ghosts are removed, and
/// two landmarks that turn out to be one are merged.
class EkfSlam final : public Filter {
 public:
  /// Of `sensor` it takes where it sits, its lasting errors, and its noise where an observation brings no
  /// covariance; with EkfOptions::unknown also its limits. `threads` share updates of large maps; the result
  /// does not depend on them. Takes all its memory here. One object must not be used by two threads at once;
  /// two objects may.
  EkfSlam(const EkfOptions& options, const LandmarkSensor& sensor, int threads = 1);

  /// Starts from a saved map of 2-D landmarks, no more than `options.loaded`, with all its correlations; only
  /// before anything else. Changes nothing where it does not fit. The lasting errors of the sensor begin
  /// anew. What a map says is there is taken to be there: a landmark without identity is neither tentative
  /// nor forgotten.
  [[nodiscard]] Result<void> load(const MapState& map);

  /// From now on the landmarks stay as they are and no others are added: what they are unsure of is
  /// considered (Schmidt 1966 \cite schmidt1966), and only the pose and the sensor's lasting errors are
  /// estimated.
  void hold_landmarks();

  /// Puts the robot somewhere else, as sure of it as the covariance says.
  void place_robot(const PoseEstimate& pose) { state_.place_robot(pose); }

  void predict(const Motion& motion) override;
  const Correction& correct(std::span<const Observation> observations) override;
  [[nodiscard]] PoseEstimate pose() const override { return state_.pose(); }
  [[nodiscard]] Snapshot snapshot() const override;
  [[nodiscard]] MapState save() const override;
  [[nodiscard]] const FunctionBlocks& blocks() const override { return blocks_; }
  [[nodiscard]] std::optional<CalibrationEstimate> calibration() const override;

  [[nodiscard]] const ekf::CompressedState& state() const { return state_; }
  /// How often the robot must have slipped far beyond its odometry: see Recovery.
  [[nodiscard]] int slips() const { return recovery_.slips(); }
  /// Pairs of landmarks that turned out to be one.
  [[nodiscard]] int merges() const { return merges_; }

 private:
  /// A point of the state: a landmark, or one of a place where the sensor was.
  struct Landmark {
    LandmarkId id = {};
    bool is_viewpoint = false;
    int observations = 0;
    std::optional<Existence> existence = {};  ///< of one that was met without a name
    double seen_at_way_m = 0.0;
    int claimed_at_scan = 0;  ///< by a sighting without a name
    double sigma_m = 0.0;     ///< its position's when it was last seen: later it is no more
    Eigen::Vector2d place_m = Eigen::Vector2d::Zero();  ///< as it was last asked for
  };

  /// A sighting without a name that may be of a landmark.
  struct Candidate {
    int observation = 0;
    double cost = 0.0;  ///< -2 log-likelihood, but for a constant
    double nis = 0.0;
    Eigen::Matrix2d S;
    ekf::Sighting sighting;
  };

  /// What only sightings without a name need.
  struct Unnamed {
    Unnamed(const UnknownAssociation& association, const GateOptions& gate, const LandmarkSensor& sensor);

    AssociationModel model;
    LandmarkSensor sensor;
    bool jointly;
    ExclusiveMatch exclusive;
    JointMatch joint;
    GridIndex grid;
    std::vector<Eigen::Vector2d> places;  // of the landmarks, in grid
    double sigma_m = 0.0;                 // largest of a landmark
    std::vector<char> open;               // by observation: still without a landmark
    std::vector<Candidate> candidates;
    std::vector<int> considered;  // their landmarks
    int scan = 0;
    int next_number = 0;
  };

  struct Duplicate {
    double score = 0.0;
    int landmark = -1;
    int twin = -1;
  };

  struct View {
    Pose2 T_world_robot;
    Eigen::Vector3d p_world;
  };

  [[nodiscard]] Outcome of_no_landmark() const { return held_ ? Outcome::kNotInMap : Outcome::kAdded; }
  /// A place where the sensor was: indices of its points in the state, and how many views hang on it.
  struct Viewpoint {
    int place = -1;
    int ahead = -1;  ///< a metre ahead of it; -1 where no direction was measured
    int users = 0;
  };

  /// A range or a bearing that is kept.
  struct PartialView {
    int viewpoint;
    Measurement value;
    double variance;
  };

  /// A landmark of which too little is known to have it in the state.
  struct Unlocated {
    LandmarkId id;
    std::vector<PartialView> views = {};
    double seen_at_way_m = 0.0;
    double spacing_m;
  };

  void prepare(std::size_t count);
  void associate(std::size_t index, const Observation& observation);
  void compare(Innovation& innovation, const std::optional<ekf::Sighting>& sighting);
  void gate_again(const Motion& slip, std::span<const Observation> observations);
  /// Nothing where the landmark is believed to be at the sensor itself.
  [[nodiscard]] std::optional<ekf::Sighting> linearize(int landmark, const Observation& observation) const;
  [[nodiscard]] std::optional<ekf::Sighting> linearize_at_proposal(const ekf::Sighting& before,
                                                                   const Observation& observation) const;
  [[nodiscard]] static std::optional<ekf::Sighting> sight(const Measurement& value, const View& here,
                                                          const View& at, const Pose2& T_robot_sensor);
  [[nodiscard]] ekf::SightingError error_of(LandmarkId id, double range_m, const Measurement& value) const;
  void collect(std::size_t index, const Observation& observation);
  [[nodiscard]] bool refine(std::span<const Observation> observations);
  [[nodiscard]] bool relinearize(std::span<const Observation> observations);
  [[nodiscard]] double heaviness(const ekf::Sighting& left, const Eigen::Matrix2d& R) const;
  void update(std::span<const Observation> observations);
  [[nodiscard]] bool make_room();
  void remove(int landmark);
  void add(std::size_t index, const Observation& observation);
  int append(const Eigen::Vector2d& p_world, const Eigen::Matrix2d& noise, const ekf::ErrorTerms& errors,
             const Landmark& landmark);
  [[nodiscard]] bool already_seen(std::size_t index, LandmarkId id) const;
  [[nodiscard]] bool is_in_map(const Landmark& landmark) const {
    return !landmark.is_viewpoint && (!landmark.existence || landmark.existence->is_confirmed());
  }
  [[nodiscard]] static bool has_name(const Landmark& landmark) {
    return !landmark.is_viewpoint && !landmark.existence;
  }

  // Of ranges or bearings alone.
  [[nodiscard]] int viewpoint_here(bool with_direction);
  void release(int viewpoint);
  void renumber_viewpoint(int from, int to);
  void defer(std::size_t index, const Observation& observation);
  void thin(Unlocated& unlocated);
  template <class Here, class At>
  [[nodiscard]] std::optional<ekf::Sighting> look_back(const PartialView& view,
                                                       const Eigen::Vector2d& p_world, const Here& here,
                                                       const At& at) const;
  [[nodiscard]] std::optional<ekf::ViewsOfOne> views_at(const Unlocated& unlocated,
                                                        const Eigen::Vector2d& p_world) const;
  void consider_views(const Unlocated& unlocated, int landmark);
  [[nodiscard]] bool locate(const Unlocated& unlocated);
  [[nodiscard]] bool place(const Unlocated& unlocated, const Eigen::Vector2d& p_world, double anywhere_m);
  [[nodiscard]] bool gather_views(const Unlocated& unlocated, int landmark, bool at_proposal);

  // Of sightings without a name.
  void match_unnamed(std::span<const Observation> observations);
  void index_places();
  [[nodiscard]] bool is_place_due(int landmark, const Eigen::Vector2d& p_sensor) const;
  template <class Visit>
  void visit_candidates(const Observation& observation, const Visit& visit) const;
  [[nodiscard]] double reach_m(const Observation& observation) const;
  void find_candidates(int index, const Observation& observation);
  [[nodiscard]] bool consider(int landmark);
  [[nodiscard]] double bonus(const Candidate& candidate, const Observation& observation) const;
  void match_jointly(std::span<const Observation> observations);
  void match_exclusively(std::span<const Observation> observations);
  void take_match(const Candidate& candidate);
  void settle_leftovers(std::span<const Observation> observations);
  [[nodiscard]] bool is_near_a_landmark(const Observation& observation) const;
  void update_existence();
  [[nodiscard]] bool should_be_seen(int landmark, const Eigen::Vector2d& p_sensor) const;
  void merge_duplicates();
  void find_duplicates(int landmark, Duplicate& best);
  [[nodiscard]] ekf::Sighting difference(int landmark, int twin) const;
  void merge(const Duplicate& duplicate);
  void forget_ghosts();
  void name(Innovation& added);
  void note_sigma(int landmark);

  ekf::LastingErrors errors_;
  ekf::OdometryStates odometry_;
  ekf::CompressedState state_;
  CompletedObservations completed_;
  EkfOptions options_;
  Gate gate_;
  Recovery recovery_;
  Pose2 T_robot_sensor_;
  IdIndex index_;
  ekf::MapManagement management_;
  std::vector<Landmark> landmarks_;  // by index in the state
  std::optional<Unnamed> unnamed_;
  bool held_ = false;  // nothing is added
  std::vector<Viewpoint> viewpoints_;
  std::vector<Unlocated> unlocated_;
  int viewpoint_of_scan_ = -1;
  double way_m_ = 0.0;
  int merges_ = 0;
  std::vector<int> matched_;              // by observation: index of its landmark, or -1
  std::vector<Innovation> innovations_;   // one per observation of the last correct()
  std::vector<ekf::Sighting> sightings_;  // of one block of the update
  std::vector<Eigen::Matrix2d> noises_;   // their noise without heavy tails
  std::vector<ekf::Sighting> refined_;    // the same, linearised anew
  std::vector<std::size_t> seen_;         // their observations
  std::vector<LandmarkId> removed_;       // from the map by the last correct()
  Correction correction_;
  FunctionBlocks blocks_{"FB1 predict", "FB3 associate", "FB6 estimate", "FB9 add"};
};

}  // namespace waymark
