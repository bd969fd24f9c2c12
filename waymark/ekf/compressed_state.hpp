#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/ekf/accumulators.hpp"
#include "waymark/ekf/passive_map.hpp"
#include "waymark/ekf/state.hpp"

namespace waymark::ekf {

/// How a large map is kept out of the way.
struct Compression {
  int region = 64;  ///< landmarks in a region; more where so many are seen at once
  int onset = 384;  ///< size of the map from which on it is done; the capacity of the map: never
};

/// The state of the whole map at the cost of a local one: the compressed filter of Guivant and Nebot (2001).
///
/// The robot and the landmarks of its region are an ekf::State of their own, the active one. The others are
/// left as they were when the region was opened; what they have missed is gathered in accumulators and worked
/// in later, by a second thread if there is one. A landmark that is sighted again enters the region there and
/// then. When the region is full it is closed, the landmarks seen last stay for the next one, and the map is
/// brought up to date meanwhile: a little at every update(), and in time before the next region is full.
/// Everything asked for is answered as if that work were done, and the result has the same bits for any
/// number of threads.
///
/// Exactly the same filter as State with kStandard and kFej. With kInvariant the landmarks outside of the
/// region are turned with the robot once per region and not at every update: the estimates are the same to
/// first order in the innovations, and the covariance stays positive.
///
/// With n_a = 3 + dimension * landmarks of the region, an update of D rows costs 4 n_a^2 D flop whatever the
/// size n of the map, bringing a landmark in n_a^2, and closing a region n^2 n_a + 4 n n_a^2 altogether.
class CompressedState {
 public:
  CompressedState(int dimension, int capacity, Consistency consistency, const Compression& compression,
                  int threads = 1, int error_pairs = 0);

  [[nodiscard]] int dimension() const { return active_.dimension(); }
  [[nodiscard]] int landmarks() const { return static_cast<int>(slots_.size()); }
  [[nodiscard]] int capacity() const { return capacity_; }
  static constexpr int kMaxSightings = State::kMaxSightings;

  /// As those of State.
  [[nodiscard]] PoseEstimate pose() const { return active_.pose(); }
  [[nodiscard]] Eigen::Vector3d landmark(int index) const;
  [[nodiscard]] Eigen::Matrix3d landmark_covariance(int index) const;
  [[nodiscard]] Pose2 linearization_pose() const { return active_.linearization_pose(); }
  [[nodiscard]] Eigen::Vector3d linearization_landmark(int index) const;
  void place_robot(const PoseEstimate& pose) { active_.place_robot(pose); }
  void hold_landmarks() { active_.hold_landmarks(); }
  /// All landmarks together are the first region: there must be that many before the onset.
  void load(const Eigen::Ref<const Eigen::VectorXd>& mean, const Eigen::Ref<const Eigen::MatrixXd>& P);
  /// Landmarks that load() may bring.
  [[nodiscard]] int most_loaded() const { return active_.capacity(); }
  /// Motions that depend on lasting errors are for maps that are never compressed.
  void predict(const Motion& motion, const ErrorTerms& errors = {});
  [[nodiscard]] Eigen::Vector2d errors(int pair) const { return active_.errors(pair); }
  [[nodiscard]] Eigen::Matrix2d errors_covariance(int pair, int other) const {
    return active_.errors_covariance(pair, other);
  }
  [[nodiscard]] Eigen::Vector2d expected(const ErrorTerms& terms) const { return active_.expected(terms); }
  void relax_errors(int pair, double rho);
  [[nodiscard]] Eigen::Matrix2d innovation_covariance(const Sighting& sighting) const;
  [[nodiscard]] Eigen::Matrix<double, 3, 2> pose_correlation(const Sighting& sighting) const;
  /// Brings landmarks, each named once, into the region: they may have been seen. No more than a third of it.
  void consider(std::span<const int> landmarks);
  /// Of landmarks in the region.
  [[nodiscard]] Eigen::Matrix2d common_covariance(const Sighting& a, const Sighting& b) const {
    return active_.common_covariance(in_active(a), in_active(b));
  }
  [[nodiscard]] bool update(std::span<const Sighting> sightings);
  /// The anchors of a sighting, if any, must be in the region.
  [[nodiscard]] bool propose(std::span<const Sighting> sightings);
  void accept();
  /// Of sighted landmarks only.
  [[nodiscard]] Pose2 proposed_pose() const { return active_.proposed_pose(); }
  [[nodiscard]] Eigen::Vector3d proposed_landmark(int index) const {
    return active_.proposed_landmark(local_of(index));
  }
  [[nodiscard]] Eigen::Vector2d proposed_expected(const ErrorTerms& terms) const {
    return active_.proposed_expected(terms);
  }
  [[nodiscard]] Eigen::Vector2d explained(const Sighting& sighting) const {
    return active_.explained(in_active(sighting));
  }
  [[nodiscard]] Sighting moved_back(const Sighting& sighting) const;
  int add(const Eigen::Vector3d& position, const Eigen::Matrix3d& G_pose, const Eigen::Matrix3d& noise,
          const ErrorTerms& errors = {});
  void remove(int index);
  [[nodiscard]] Eigen::VectorXd mean() const;
  [[nodiscard]] Eigen::MatrixXd covariance() const;

  /// Landmarks in the present region.
  [[nodiscard]] int active_landmarks() const { return active_.landmarks(); }
  [[nodiscard]] bool is_active(int index) const { return local_of(index) >= 0; }
  /// Regions closed so far.
  [[nodiscard]] int closed_regions() const { return closed_regions_; }
  /// Nothing is left to do for the last of them.
  [[nodiscard]] bool settled() const { return passive_.done(); }

 private:
  [[nodiscard]] Sighting in_active(const Sighting& sighting) const;
  /// Counted by update(); a landmark that was removed was never seen.
  using Clock = std::int64_t;
  static constexpr Clock kRemoved = -1;

  /// A passive landmark as it is now. What it has in common with the region is in base_ and cross_.
  struct Recalled {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d shear = Eigen::Vector3d::Zero();  ///< d of its coordinates
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  };

  [[nodiscard]] int slot_of(int index) const { return slots_[static_cast<std::size_t>(index)]; }
  [[nodiscard]] int local_of(int index) const {
    return local_of_slot_[static_cast<std::size_t>(slot_of(index))];
  }
  /// How many landmarks the region may have.
  [[nodiscard]] int limit() const;

  [[nodiscard]] Eigen::Vector3d displacement(int slot) const;
  [[nodiscard]] Recalled recall(int slot) const;
  [[nodiscard]] Eigen::Index row(int index) const { return 3 + dimension() * index; }
  void activate(int slot);
  void enter(int slot);
  void make_room();
  void close_region();
  void let_the_others_leave();
  void leave(int local);
  [[nodiscard]] int take_slot();
  void join();
  void count(int landmark);
  void mark_seen(int landmark);
  void bring_in(std::span<const Sighting> sightings);
  void work();

  int capacity_;
  Compression compression_;
  State active_;
  Accumulators since_;          // of active_ since the region was opened; idle until the map exceeds a region
  mutable PassiveMap passive_;  // a question may be a reason to do work early
  bool compressing_ = false;
  int closed_regions_ = 0;

  std::vector<int> slots_;          // by landmark
  std::vector<int> local_of_slot_;  // index in active_, or -1
  std::vector<int> free_slots_;
  int used_slots_ = 0;
  std::vector<int> members_;   // slots by index in active_
  std::vector<Clock> seen_;    // the same
  std::vector<Clock> ranked_;  // scratch

  Clock now_ = 0;
  Clock step_began_ = 0;
  int seen_this_step_ = 0;
  int most_seen_ = 0;          // in one step of this region
  int room_ = 0;               // when the region was opened
  double closing_work_ = 0.0;  // flop, then

  bool proposed_ = false;
  std::vector<Sighting> local_sightings_;
  // Of the landmark recalled last, n_a x dimension: its columns when the region was opened, -psi times them,
  // and now.
  mutable Eigen::MatrixXd base_;
  mutable Eigen::MatrixXd minus_psi_base_;
  mutable Eigen::MatrixXd cross_;
};

}  // namespace waymark::ekf
