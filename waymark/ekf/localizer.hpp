#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "waymark/association/find_pose.hpp"
#include "waymark/association/local_map.hpp"
#include "waymark/ekf/ekf_slam.hpp"

namespace waymark {

/// Localisation in a saved map that stays unchanged.
///
/// The robot may start anywhere: observations are collected in its frame until enough of them are
/// arranged as in the map (find_pose()). That gives the point of linearisation; the pose then comes from
/// an update with all collected observations, so that pose and map are correctly correlated. From there
/// on it is EkfSlam with considered landmarks, whose uncertainty counts but which do not change (Schmidt
/// 1966 \cite schmidt1966).
///
/// If observations contradict the map for long, localisation starts again. If twenty observations give no
/// pose, the filter gives up and reports the reason; sooner if no two of several landmarks are arranged
/// as in the map.
class Localizer final : public Filter {
 public:
  /// A filter over the map, or why it cannot be one. Options and sensor as EkfSlam's; capacity, consistency
  /// and compression are those that a map which is held needs. One object must not be used by two threads at
  /// once.
  [[nodiscard]] static Result<std::unique_ptr<Localizer>> make(MapState map, const EkfOptions& options,
                                                               const LandmarkSensor& sensor, int threads = 1);

  void predict(const Motion& motion) override;
  const Correction& correct(std::span<const Observation> observations) override;
  [[nodiscard]] PoseEstimate pose() const override { return ekf_.pose(); }
  [[nodiscard]] bool knows_pose() const override { return located_; }
  [[nodiscard]] std::optional<Error> refusal() const override { return refusal_; }
  [[nodiscard]] Snapshot snapshot() const override { return ekf_.snapshot(); }
  [[nodiscard]] MapState save() const override { return ekf_.save(); }
  [[nodiscard]] const FunctionBlocks& blocks() const override { return ekf_.blocks(); }

  /// How often the robot was lost again.
  [[nodiscard]] int losses() const { return losses_; }

 private:
  Localizer(MapState map, const EkfOptions& options, const LandmarkSensor& sensor, int threads);
  void remember(const Observation& observation);
  [[nodiscard]] bool is_enough(const PoseCandidates& found) const;
  [[nodiscard]] bool is_elsewhere(const PoseCandidates& found) const;
  [[nodiscard]] std::string reason(const PoseCandidates& found) const;
  [[nodiscard]] int seen_of_map() const;
  const Correction& search_pose(std::span<const Observation> observations);
  const Correction& localize_at(const PoseCandidate& found);
  void judge(const Correction& correction);

  MapState map_;
  Pose2 T_robot_sensor_;
  bool unknown_;
  CompletedObservations completed_;
  LocalMap local_map_;  // of a robot that is not located
  EkfSlam ekf_;
  bool located_ = false;
  std::optional<Error> refusal_;
  int observations_ = 0;   // in it
  double driven_s_ = 0.0;  // meanwhile
  int doubt_ = 0;          // observations that contradict, less those that agree
  int losses_ = 0;
  std::vector<Innovation> innovations_;
  Correction searching_;
};

}  // namespace waymark
