#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "waymark/core/stamp.hpp"

namespace waymark::live {

/// Quantiles of many times in little memory: bins of 2 % from 1 us to 100 s.
class LatencyHistogram {
 public:
  LatencyHistogram();

  void add(double time_s);
  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] double max_s() const { return max_s_; }
  /// The upper end of the bin that it lies in, and never above the largest; 0 where there is nothing.
  [[nodiscard]] double quantile_s(double part) const;
  /// How many were longer; exact to the width of a bin.
  [[nodiscard]] std::int64_t count_above(double time_s) const;

 private:
  [[nodiscard]] static std::size_t bin_of(double time_s);

  std::vector<std::int64_t> bins_;
  std::int64_t count_ = 0;
  double max_s_ = 0.0;
};

/// How long it takes from what is observed to the corrected pose. A correction needs the odometry of its
/// moment too, so waiting for that is counted apart.
class CorrectionLatency {
 public:
  void odometry_arrived(Stamp stamp, Stamp arrived);
  void observation_arrived(Stamp stamp, Stamp arrived);
  void corrected(Stamp stamp, Stamp now);

  [[nodiscard]] const LatencyHistogram& waits() const { return waits_; }          ///< for odometry
  [[nodiscard]] const LatencyHistogram& latencies() const { return latencies_; }  ///< from both to the pose

 private:
  struct Seen {
    Stamp stamp;
    Stamp arrived;
  };
  static void keep(std::deque<Seen>& seen, Stamp stamp, Stamp arrived);

  std::deque<Seen> odometry_;
  std::deque<Seen> observations_;
  LatencyHistogram waits_;
  LatencyHistogram latencies_;
};

}  // namespace waymark::live
