#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/ekf/compressed_terms.hpp"
#include "waymark/ekf/passive_submap.hpp"
#include "waymark/ekf/recall.hpp"
#include "waymark/ekf/recency.hpp"
#include "waymark/ekf/slots.hpp"
#include "waymark/ekf/state.hpp"
#include "waymark/ekf/switch_schedule.hpp"

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
/// worked in later, by a second thread if there is one. A landmark that is observed again enters the submap
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
                  int threads = 1, int bias_pairs = 0);

  /// The robot, the biases and the landmarks of the submap, these under indices of its own: whoever asks for
  /// the robot or for biases asks this. Landmarks are asked for below, by their index in the map.
  [[nodiscard]] const State& active() const { return active_; }
  [[nodiscard]] bool is_active(int index) const { return slots_.is_active(index); }
  /// Submaps closed so far.
  [[nodiscard]] int closed_submaps() const { return closed_submaps_; }
  /// Nothing is left to do for the last of them.
  [[nodiscard]] bool is_up_to_date() const { return passive_.done(); }

  [[nodiscard]] int landmarks() const { return slots_.landmarks(); }
  [[nodiscard]] int capacity() const { return capacity_; }
  static constexpr int kMaxObservations = State::kMaxObservations;

  // As those of State, of any landmark of the map.
  [[nodiscard]] Eigen::Vector3d landmark(int index) const;
  [[nodiscard]] Eigen::Matrix3d landmark_covariance(int index) const;
  [[nodiscard]] Eigen::Vector3d linearization_landmark(int index) const;
  [[nodiscard]] Eigen::Matrix2d innovation_covariance(const LinearizedObservation& linearization) const;
  [[nodiscard]] Eigen::Matrix<double, 3, 2> pose_correlation(
      const LinearizedObservation& linearization) const;
  [[nodiscard]] Eigen::VectorXd mean() const;
  [[nodiscard]] Eigen::MatrixXd covariance() const;

  // As those of State, of landmarks in the submap: observed or considered before.
  [[nodiscard]] Eigen::Matrix2d common_covariance(const LinearizedObservation& a,
                                                  const LinearizedObservation& b) const;
  [[nodiscard]] Proposal proposal() const { return active_.proposal().with_indices_of(slots_); }

  /// All landmarks together are the first submap: there must be that many before the onset, and no more than
  /// active().capacity().
  void load(const Eigen::Ref<const Eigen::VectorXd>& mean, const Eigen::Ref<const Eigen::MatrixXd>& P);
  void place_robot(const PoseEstimate& pose) { active_.place_robot(pose); }
  void hold_landmarks() { active_.hold_landmarks(); }
  /// Motions that depend on biases are for maps that are never compressed.
  void predict(const Motion& motion, const BiasTerms& errors = {});
  void propagate_bias(int pair, double rho);
  /// Brings landmarks, each named once, into the submap: they may have been seen. No more than a third of it.
  void consider(std::span<const int> landmarks);
  [[nodiscard]] bool update(std::span<const LinearizedObservation> linearizations);
  /// The anchors of an observation, if any, must be in the submap.
  [[nodiscard]] bool propose(std::span<const LinearizedObservation> linearizations);
  void accept();
  int add(const Eigen::Vector3d& position, const Eigen::Matrix3d& G_pose, const Eigen::Matrix3d& noise,
          const BiasTerms& errors = {});
  void remove(int index);

 private:
  /// How many landmarks the submap may have.
  [[nodiscard]] int limit() const;

  void join();
  void bring_in(std::span<const LinearizedObservation> linearizations);
  void activate(int index);
  void make_room();
  void let_the_others_leave();
  void enter(int slot);
  void leave(int local);

  int capacity_;
  Compression compression_;
  State active_;
  CompressedTerms since_;  // of active_ since the submap was opened; idle until the map exceeds a submap
  mutable PassiveSubmap passive_;  // a question may be a reason to do work early
  Slots slots_;
  Recency recency_;
  mutable Recall recall_;

  bool compressing_ = false;
  int closed_submaps_ = 0;
  SwitchSchedule schedule_;
  bool proposed_ = false;
  std::vector<LinearizedObservation> local_linearizations_;
};

}  // namespace waymark::ekf
