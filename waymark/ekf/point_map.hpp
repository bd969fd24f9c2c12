#pragma once

#include <vector>

#include <Eigen/Core>

#include "waymark/association/landmark_table.hpp"
#include "waymark/core/as_index.hpp"
#include "waymark/core/map_state.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/core/result.hpp"
#include "waymark/ekf/compressed_state.hpp"
#include "waymark/ekf/ekf_options.hpp"
#include "waymark/ekf/map_management.hpp"

namespace waymark::ekf {

/// The map of a filter of 2-D landmarks: all that is kept of a landmark stands under the same index, in the
/// state, in the table and in map management, and only append() and remove() change which index that is. All
/// memory is taken at construction, as far as LandmarkTable does.
///
/// Beside landmarks the state may hold points that are none. They are referred to by a handle, which stays
/// the same when landmarks are removed and indices change.
class PointMap {
 public:
  /// The state has `bias_pairs` pairs of biases; `threads` share updates of large maps.
  PointMap(const EkfOptions& options, int bias_pairs, int threads);

  [[nodiscard]] CompressedState& state() { return state_; }
  [[nodiscard]] const CompressedState& state() const { return state_; }
  [[nodiscard]] LandmarkTable& table() { return table_; }
  [[nodiscard]] const LandmarkTable& table() const { return table_; }
  [[nodiscard]] MapManagement& management() { return management_; }

  /// As EkfSlam::load(): only before anything else; changes nothing where the map does not fit.
  [[nodiscard]] Result<void> load(const MapState& map);
  /// Robot and landmarks of the map, without tentative ones; allocates. The stamp is the caller's to fill in.
  [[nodiscard]] Snapshot snapshot() const;
  /// The same with all correlations; allocates. Stamp and provenance are the caller's to fill in.
  [[nodiscard]] MapState save() const;

  /// Appends a point that was seen from the robot, so that it turns with it: position in the world,
  /// covariance of what the observation adds (m^2), and how biases are in it. Returns its index.
  /// There must be room. O(n).
  int append(const Eigen::Vector2d& p_world, const Eigen::Matrix2d& noise, const BiasTerms& errors,
             const LandmarkRecord& record);
  /// Marginalises a landmark out; the last one takes its index. O(n).
  void remove(int landmark);
  /// Whether there is room for one more, if need be by removing the least useful landmark.
  [[nodiscard]] bool make_room();

  /// Appends a point that is no landmark, as the robot's pose has it; never evicted. Returns its handle.
  [[nodiscard]] int append_point(const Eigen::Vector2d& p_world);
  [[nodiscard]] int index_of_point(int handle) const { return points_[as_index(handle)]; }
  void remove_point(int handle);

  /// How far off a landmark may be without asking a compressed state, where that is dear: its place when
  /// refresh_place() was last called, world frame, and the standard deviation (root of the trace, m) when
  /// note_sigma() was.
  [[nodiscard]] const Eigen::Vector2d& place(int landmark) const {
    return extents_[as_index(landmark)].place;
  }
  [[nodiscard]] double sigma_m(int landmark) const { return extents_[as_index(landmark)].sigma_m; }
  void refresh_place(int landmark) {
    extents_[as_index(landmark)].place = state_.landmark(landmark).head<2>();
  }
  void note_sigma(int landmark);

 private:
  struct Extent {
    Eigen::Vector2d place = Eigen::Vector2d::Zero();
    double sigma_m = 0.0;
  };

  CompressedState state_;
  MapManagement management_;
  LandmarkTable table_;
  std::vector<Extent> extents_;  // by landmark
  std::vector<int> points_;      // index by handle; -1: free
  int loaded_;                   // landmarks that load() was said to bring
};

}  // namespace waymark::ekf
