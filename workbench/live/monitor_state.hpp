#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "waymark/core/map_state.hpp"

#include "workbench/live/latency.hpp"
#include "workbench/live/light.hpp"
#include "workbench/live/pose_of_now.hpp"

namespace waymark::live {

/// What the monitor's page shows at one moment.
struct MonitorState {
  Light light;
  double since_start_s = 0.0;
  std::optional<StampedPose> pose;
  const std::vector<LandmarkEstimate>* landmarks = nullptr;  ///< null: as they were
  std::vector<StreamSummary> streams;
  const LatencyHistogram* corrections = nullptr;
  std::int64_t late = 0;
  std::uint64_t image = 0;        ///< counts up with each new one; 0: none
  std::string recording;          ///< file, size and fault; empty: none
  std::optional<double> free_mb;  ///< of the disk that results are written to
  int marks = 0;
};

/// As the page's script reads it. Numbers are rounded to what a page can show; an ellipse is told by its
/// semi-axes of one standard deviation in m and its angle in rad.
[[nodiscard]] std::string to_json(const MonitorState& state);

/// The way so far, thinned: every second point goes whenever there are `kMost`, and from then on only every
/// second, fourth, ... is kept.
class Trail {
 public:
  static constexpr std::size_t kMost = 2000;

  void add(const Pose2& pose);
  /// [[x, y], ...] in m.
  [[nodiscard]] std::string to_json() const;

 private:
  std::vector<Pose2> points_;
  std::uint64_t stride_ = 1;
  std::uint64_t count_ = 0;
};

}  // namespace waymark::live
