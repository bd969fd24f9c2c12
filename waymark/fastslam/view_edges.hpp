#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "waymark/fastslam/belief.hpp"
#include "waymark/fastslam/scan.hpp"
#include "waymark/fastslam/sensor_model.hpp"
#include "waymark/fastslam/view_history.hpp"

namespace waymark::fastslam {

/// A landmark that stood on an edge of the field of view, between two scans: a bearing of plus or minus half
/// the view from where the sensor was then, without the landmark's view.
struct ViewEdge {
  int landmark = 0;
  kernels::LandmarkObservation observation;
};

/// Finds landmarks that crossed an edge of the field of view: those that were seen by their range alone and
/// now are not, or now are and were not, at a range well within the sensor's limits. Whether one was missed
/// by chance instead shows in as many scans as it takes, (1 - detection probability)^n < 0.001; where that
/// would be more than four or the view has no edges, none is found.
class ViewEdges {
 public:
  explicit ViewEdges(const SensorModel& model);

  /// Of a scan whose observations were gated. Valid until the next call. O(landmarks).
  [[nodiscard]] std::span<const ViewEdge> find(const Scan& scan, const ViewHistory& history,
                                               const Belief& belief);

 private:
  void add(int landmark, double range_m, std::size_t age, const ViewHistory& history);

  SensorModel model_;
  std::size_t scans_to_tell_;  // 0: never
  std::vector<ViewEdge> edges_;
};

}  // namespace waymark::fastslam
