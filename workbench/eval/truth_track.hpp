#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/event.hpp"
#include "waymark/core/trajectory.hpp"

namespace waymark::eval {

struct TruthSample {
  Stamp stamp;
  Truth truth;
};

[[nodiscard]] inline Eigen::Vector2d position_of(const Truth& truth) { return {truth.x_m, truth.y_m}; }

/// The true pose, or nothing where the heading was not measured.
[[nodiscard]] std::optional<Pose2> pose_of(const Truth& truth);

/// Ground truth of one run in order of time, one sample per stamp. It may be dense (motion capture) or a few
/// surveyed marks, and may lack headings.
class TruthTrack {
 public:
  TruthTrack() = default;

  /// Samples in any order. Of several with one stamp the first is kept; those that are not finite are
  /// dropped. O(n log n).
  explicit TruthTrack(std::vector<TruthSample> samples);

  /// The `Truth` events of a log.
  [[nodiscard]] static TruthTrack from_events(std::span<const Event> events);

  /// A reference path of somebody else, headings included.
  [[nodiscard]] static TruthTrack from_trajectory(const Trajectory& trajectory);

  [[nodiscard]] const std::vector<TruthSample>& samples() const { return samples_; }
  [[nodiscard]] bool empty() const { return samples_.empty(); }

  /// Truth at any moment: straight line and shorter turn between neighbours. Nothing outside the track and in
  /// holes longer than `max_gap`; no heading unless both neighbours have one. O(log n).
  [[nodiscard]] std::optional<Truth> at(Stamp stamp, Duration max_gap = std::chrono::milliseconds(200)) const;

 private:
  std::vector<TruthSample> samples_;
};

}  // namespace waymark::eval
