#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/ekf/accumulators.hpp"
#include "waymark/ekf/passive_map.hpp"
#include "waymark/ekf/recall.hpp"
#include "waymark/ekf/recency.hpp"
#include "waymark/ekf/slots.hpp"
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

  /// Who asks for the robot, the lasting errors or what is proposed for these asks the active state. It has
  /// the landmarks of the region under indices of its own.
  [[nodiscard]] const State& active() const { return active_; }
  [[nodiscard]] bool is_active(int index) const { return slots_.is_active(index); }
  /// Regions closed so far.
  [[nodiscard]] int closed_regions() const { return closed_regions_; }
  /// Nothing is left to do for the last of them.
  [[nodiscard]] bool settled() const { return passive_.done(); }

  [[nodiscard]] int landmarks() const { return slots_.landmarks(); }
  [[nodiscard]] int capacity() const { return capacity_; }
  static constexpr int kMaxSightings = State::kMaxSightings;

  // As those of State, of any landmark of the map.
  [[nodiscard]] Eigen::Vector3d landmark(int index) const;
  [[nodiscard]] Eigen::Matrix3d landmark_covariance(int index) const;
  [[nodiscard]] Eigen::Vector3d linearization_landmark(int index) const;
  [[nodiscard]] Eigen::Matrix2d innovation_covariance(const Sighting& sighting) const;
  [[nodiscard]] Eigen::Matrix<double, 3, 2> pose_correlation(const Sighting& sighting) const;
  [[nodiscard]] Eigen::VectorXd mean() const;
  [[nodiscard]] Eigen::MatrixXd covariance() const;

  // As those of State, of landmarks in the region: sighted or considered before.
  [[nodiscard]] Eigen::Matrix2d common_covariance(const Sighting& a, const Sighting& b) const {
    return active_.common_covariance(in_active(a), in_active(b));
  }
  [[nodiscard]] Eigen::Vector3d proposed_landmark(int index) const {
    return active_.proposal().landmark(slots_.local_of(index));
  }
  [[nodiscard]] Eigen::Vector2d explained(const Sighting& sighting) const {
    return active_.proposal().explained(in_active(sighting));
  }
  [[nodiscard]] Sighting moved_back(const Sighting& sighting) const;

  /// All landmarks together are the first region: there must be that many before the onset, and no more than
  /// active().capacity().
  void load(const Eigen::Ref<const Eigen::VectorXd>& mean, const Eigen::Ref<const Eigen::MatrixXd>& P);
  void place_robot(const PoseEstimate& pose) { active_.place_robot(pose); }
  void hold_landmarks() { active_.hold_landmarks(); }
  /// Motions that depend on lasting errors are for maps that are never compressed.
  void predict(const Motion& motion, const ErrorTerms& errors = {});
  void relax_errors(int pair, double rho);
  /// Brings landmarks, each named once, into the region: they may have been seen. No more than a third of it.
  void consider(std::span<const int> landmarks);
  [[nodiscard]] bool update(std::span<const Sighting> sightings);
  /// The anchors of a sighting, if any, must be in the region.
  [[nodiscard]] bool propose(std::span<const Sighting> sightings);
  void accept();
  int add(const Eigen::Vector3d& position, const Eigen::Matrix3d& G_pose, const Eigen::Matrix3d& noise,
          const ErrorTerms& errors = {});
  void remove(int index);

  // active(), question by question.
  [[nodiscard]] int dimension() const { return active_.dimension(); }
  [[nodiscard]] PoseEstimate pose() const { return active_.pose(); }
  [[nodiscard]] Pose2 linearization_pose() const { return active_.linearization_pose(); }
  [[nodiscard]] Eigen::Vector2d expected(const ErrorTerms& terms) const { return active_.expected(terms); }
  [[nodiscard]] Pose2 proposed_pose() const { return active_.proposal().pose(); }
  [[nodiscard]] Eigen::Vector2d proposed_expected(const ErrorTerms& terms) const {
    return active_.proposal().expected(terms);
  }
  [[nodiscard]] int most_loaded() const { return active_.capacity(); }

 private:
  [[nodiscard]] Sighting in_active(const Sighting& sighting) const;
  /// How many landmarks the region may have.
  [[nodiscard]] int limit() const;

  void join();
  void count(int landmark);
  void mark_seen(int landmark);
  void bring_in(std::span<const Sighting> sightings);
  void activate(int index);
  void make_room();
  void close_region();
  void let_the_others_leave();
  [[nodiscard]] int take_slot();
  void enter(int slot);
  void leave(int local);
  void work();

  int capacity_;
  Compression compression_;
  State active_;
  Accumulators since_;          // of active_ since the region was opened; idle until the map exceeds a region
  mutable PassiveMap passive_;  // a question may be a reason to do work early
  Slots slots_;
  Recency recency_;
  mutable Recall recall_;

  bool compressing_ = false;
  int closed_regions_ = 0;
  int room_ = 0;               // when the region was opened
  double closing_work_ = 0.0;  // flop, then
  bool proposed_ = false;
  std::vector<Sighting> local_sightings_;
};

}  // namespace waymark::ekf
