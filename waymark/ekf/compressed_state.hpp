#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/ekf/compressed_terms.hpp"
#include "waymark/ekf/passive_submap.hpp"
#include "waymark/ekf/state.hpp"

namespace waymark::ekf {

/// How a large map is kept out of the way.
struct Compression {
  int submap = 64;  ///< landmarks in a submap; more where so many are seen at once
  int onset = 384;  ///< size of the map from which on it is done; the capacity of the map: never
};

/// The state of the whole map at the cost of a local one: the compressed filter of Guivant and Nebot (2001).
///
/// The robot and the landmarks of its submap are an ekf::State of their own, the active one. The others are
/// left as they were when the submap was opened; what they have missed is gathered in compressed terms and
/// worked in later, by a second thread if there is one. A landmark that is sighted again enters the submap
/// there and then. When the submap is full it is closed, the landmarks seen last stay for the next one, and
/// the map is brought up to date meanwhile: a little at every update(), and in time before the next submap is
/// full. Everything asked for is answered as if that work were done, and the result has the same bits for any
/// number of threads.
///
/// Exactly the same filter as State with kStandard and kFej. With kInvariant the landmarks outside of the
/// submap are turned with the robot once per submap and not at every update: the estimates are the same to
/// first order in the innovations, and the covariance stays positive.
///
/// With n_a = 3 + dimension * landmarks of the submap, an update of D rows costs 4 n_a^2 D flop whatever the
/// size n of the map, bringing a landmark in n_a^2, and closing a submap n^2 n_a + 4 n n_a^2 altogether.
class CompressedState {
 public:
  CompressedState(int dimension, int capacity, Consistency consistency, const Compression& compression,
                  int threads = 1, int error_pairs = 0);

  [[nodiscard]] int dimension() const { return active_.dimension(); }
  [[nodiscard]] int landmarks() const { return static_cast<int>(slots_.size()); }
  [[nodiscard]] int capacity() const { return capacity_; }
  static constexpr int kMaxObservations = State::kMaxObservations;

  /// As those of State.
  [[nodiscard]] PoseEstimate pose() const { return active_.pose(); }
  [[nodiscard]] Eigen::Vector3d landmark(int index) const;
  [[nodiscard]] Eigen::Matrix3d landmark_covariance(int index) const;
  [[nodiscard]] Pose2 linearization_pose() const { return active_.linearization_pose(); }
  [[nodiscard]] Eigen::Vector3d linearization_landmark(int index) const;
  void place_robot(const PoseEstimate& pose) { active_.place_robot(pose); }
  void hold_landmarks() { active_.hold_landmarks(); }
  /// All landmarks together are the first submap: there must be that many before the onset.
  void load(const Eigen::Ref<const Eigen::VectorXd>& mean, const Eigen::Ref<const Eigen::MatrixXd>& P);
  /// Landmarks that load() may bring.
  [[nodiscard]] int max_loaded() const { return active_.capacity(); }
  /// Motions that depend on biases are for maps that are never compressed.
  void predict(const Motion& motion, const ErrorTerms& errors = {});
  [[nodiscard]] Eigen::Vector2d errors(int pair) const { return active_.errors(pair); }
  [[nodiscard]] Eigen::Matrix2d errors_covariance(int pair, int other) const {
    return active_.errors_covariance(pair, other);
  }
  [[nodiscard]] Eigen::Vector2d expected(const ErrorTerms& terms) const { return active_.expected(terms); }
  void propagate_bias(int pair, double rho);
  [[nodiscard]] Eigen::Matrix2d innovation_covariance(const LinearizedObservation& linearization) const;
  [[nodiscard]] Eigen::Matrix<double, 3, 2> pose_correlation(
      const LinearizedObservation& linearization) const;
  /// Brings landmarks, each named once, into the submap: they may have been seen. No more than a third of it.
  void consider(std::span<const int> landmarks);
  /// Of landmarks in the submap.
  [[nodiscard]] Eigen::Matrix2d common_covariance(const LinearizedObservation& a,
                                                  const LinearizedObservation& b) const {
    return active_.common_covariance(in_active(a), in_active(b));
  }
  [[nodiscard]] bool update(std::span<const LinearizedObservation> linearizations);
  /// The anchors of an observation, if any, must be in the submap.
  [[nodiscard]] bool propose(std::span<const LinearizedObservation> linearizations);
  void accept();
  /// Of sighted landmarks only.
  [[nodiscard]] Pose2 proposed_pose() const { return active_.proposed_pose(); }
  [[nodiscard]] Eigen::Vector3d proposed_landmark(int index) const {
    return active_.proposed_landmark(local_of(index));
  }
  [[nodiscard]] Eigen::Vector2d proposed_expected(const ErrorTerms& terms) const {
    return active_.proposed_expected(terms);
  }
  [[nodiscard]] Eigen::Vector2d explained(const LinearizedObservation& linearization) const {
    return active_.explained(in_active(linearization));
  }
  [[nodiscard]] LinearizedObservation relinearized_to_prior(const LinearizedObservation& linearization) const;
  int add(const Eigen::Vector3d& position, const Eigen::Matrix3d& G_pose, const Eigen::Matrix3d& noise,
          const ErrorTerms& errors = {});
  void remove(int index);
  [[nodiscard]] Eigen::VectorXd mean() const;
  [[nodiscard]] Eigen::MatrixXd covariance() const;

  /// Landmarks in the present submap.
  [[nodiscard]] int active_landmarks() const { return active_.landmarks(); }
  [[nodiscard]] bool is_active(int index) const { return local_of(index) >= 0; }
  /// Submaps closed so far.
  [[nodiscard]] int closed_submaps() const { return closed_submaps_; }
  /// Nothing is left to do for the last of them.
  [[nodiscard]] bool settled() const { return passive_.done(); }

 private:
  [[nodiscard]] LinearizedObservation in_active(const LinearizedObservation& linearization) const;
  /// Counted by update(); a landmark that was removed was never seen.
  using Clock = std::int64_t;
  static constexpr Clock kRemoved = -1;

  /// A passive landmark as it is now. What it has in common with the submap is in base_ and cross_.
  struct Recalled {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d shear = Eigen::Vector3d::Zero();  ///< d of its coordinates
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  };

  [[nodiscard]] int slot_of(int index) const { return slots_[static_cast<std::size_t>(index)]; }
  [[nodiscard]] int local_of(int index) const {
    return local_of_slot_[static_cast<std::size_t>(slot_of(index))];
  }
  /// How many landmarks the submap may have.
  [[nodiscard]] int limit() const;

  [[nodiscard]] Eigen::Vector3d displacement(int slot) const;
  [[nodiscard]] Recalled recall(int slot) const;
  [[nodiscard]] Eigen::Index row(int index) const { return 3 + dimension() * index; }
  void activate(int slot);
  void enter(int slot);
  void make_room();
  void close_submap();
  void let_the_others_leave();
  void leave(int local);
  [[nodiscard]] int take_slot();
  void join();
  void count(int landmark);
  void mark_seen(int landmark);
  void bring_in(std::span<const LinearizedObservation> linearizations);
  void work();

  int capacity_;
  Compression compression_;
  State active_;
  CompressedTerms since_;  // of active_ since the submap was opened; idle until the map exceeds a submap
  mutable PassiveSubmap passive_;  // a question may be a reason to do work early
  bool compressing_ = false;
  int closed_submaps_ = 0;

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
  int max_seen_ = 0;           // in one step of this submap
  int room_ = 0;               // when the submap was opened
  double closing_work_ = 0.0;  // flop, then

  bool proposed_ = false;
  std::vector<LinearizedObservation> local_linearizations_;
  // Of the landmark recalled last, n_a x dimension: its columns when the submap was opened, -psi times them,
  // and now.
  mutable Eigen::MatrixXd base_;
  mutable Eigen::MatrixXd minus_psi_base_;
  mutable Eigen::MatrixXd cross_;
};

}  // namespace waymark::ekf
