#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "waymark/core/event.hpp"
#include "waymark/slam/odometry_gaps.hpp"

namespace waymark {

/// Finds where the first stream of odometry of a log is missing.
class GapSearch {
 public:
  explicit GapSearch(double max_hold_s) : gaps_(duration_from_seconds(max_hold_s)) {}

  /// Events in the order of time. Truth does not count.
  void add(const Event& event);

  [[nodiscard]] std::vector<OdometryGap> found() const { return gaps_.all(); }

 private:
  OdometryGaps gaps_;
  std::optional<std::pair<std::size_t, StreamId>> odometry_;
};

/// From when to when a log that begins at `start` has no odometry, in one line; none where it has it all
/// along.
[[nodiscard]] std::vector<std::string> describe(const std::vector<OdometryGap>& gaps, Stamp start,
                                                double max_hold_s);

}  // namespace waymark
