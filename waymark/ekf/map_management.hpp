#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace waymark::ekf {

/// One observation against the robot's pose, all before the update: P_pose its covariance, C_pose = P(pose,
/// :) H^T, S = H P H^T + R.
struct PoseObservation {
  Eigen::Matrix3d P_pose;
  Eigen::Matrix<double, 3, 2> C_pose;
  Eigen::Matrix2d S;
};

/// What the observation tells about the pose: 1/2 log(|P| / |P - C S^-1 C^T|) nats, never negative, the same
/// in all units. 1e-12 I is added to P, which is singular at a known start. 0 if S is not positive definite.
[[nodiscard]] double information_gain(const PoseObservation& observation);

/// Remembers how much information about the pose the landmarks have given, by their index in the state, so
/// that the least informative one can make room for a new one. Landmarks of the present scan are never
/// evicted. Nothing but added() beyond the capacity allocates.
class MapManagement {
 public:
  explicit MapManagement(int capacity);

  void begin_scan() { ++scan_; }
  /// A landmark was appended; a pinned one is never evicted.
  void added(bool pinned = false);
  /// The landmark was observed where it was expected.
  void matched(int landmark, const PoseObservation& observation);
  /// The landmark was observed, but outside its gate.
  void missed(int landmark);
  /// The landmark was removed and the last one took its index.
  void removed(int landmark);

  /// Whether the landmark was missed in more than half of at least ten attempts.
  [[nodiscard]] bool keeps_failing(int landmark) const;

  /// Whether the landmark was matched or added in the present scan.
  [[nodiscard]] bool is_in_scan(int landmark) const { return record(landmark).scan == scan_; }
  /// How useful the landmark has been: the smaller, the sooner it is evicted.
  [[nodiscard]] double usefulness(int landmark) const { return usefulness(record(landmark)); }

  /// Which one to evict; nothing if all landmarks are pinned or belong to the present scan. O(landmarks).
  [[nodiscard]] std::optional<int> least_useful() const;

 private:
  struct Record {
    double gain = 0.0;  ///< moving average over the matches
    int matches = 0;
    int observations = 0;
    std::int64_t scan = 0;  ///< the last one in which it was matched or added
    bool pinned = false;
  };

  [[nodiscard]] const Record& record(int landmark) const {
    return records_[static_cast<std::size_t>(landmark)];
  }
  [[nodiscard]] static double usefulness(const Record& record);

  std::int64_t scan_ = 0;
  std::vector<Record> records_;
};

}  // namespace waymark::ekf
