#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "waymark/association/landmark_table.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/fastslam/gate_sample.hpp"

namespace waymark::fastslam {

/// One scan on its way through the filter: its observations, and what has become of each so far. Takes
/// memory as scans grow, and keeps it.
struct Scan {
  static constexpr int kNone = -1;

  std::span<const Observation> observations;
  std::vector<Innovation> innovations;     ///< one per observation, as all that follows
  std::vector<int> landmarks;              ///< index of the one that was found for it, or kNone
  std::vector<std::int64_t> last_claims;   ///< the scan that claimed that one before, 0: none did
  std::vector<InnovationMoments> moments;  ///< where it was compared

  /// The next scan: nothing has become of these observations yet. They must outlive it.
  void begin(std::span<const Observation> next);

  [[nodiscard]] std::size_t size() const { return observations.size(); }
  [[nodiscard]] bool is(std::size_t index, Outcome outcome) const {
    return innovations[index].outcome == outcome;
  }
  [[nodiscard]] int count(Outcome outcome) const;
  [[nodiscard]] bool any(Outcome outcome) const { return count(outcome) > 0; }

  /// Whether an earlier observation is of the same landmark, known or new.
  [[nodiscard]] bool has_before(std::size_t index, LandmarkId id) const;

  /// The observation is of this landmark, which it claims.
  void match(std::size_t index, int landmark, LandmarkTable& table);
};

}  // namespace waymark::fastslam
