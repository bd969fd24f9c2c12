#pragma once

#include <optional>
#include <string>
#include <vector>

#include "waymark/core/filter_health.hpp"
#include "waymark/core/stamp.hpp"

namespace waymark {

/// A time in which the robot was lost.
struct LostSpan {
  Stamp from;
  std::optional<Stamp> found;  ///< empty: it still is
};

/// When the robot slipped, and when it was lost, by what the filter says of itself after every step.
class PoseLosses {
 public:
  void add(Stamp stamp, const FilterHealth& health);

  [[nodiscard]] const std::vector<Stamp>& slips() const { return slips_; }
  [[nodiscard]] const std::vector<LostSpan>& lost() const { return lost_; }

 private:
  std::vector<Stamp> slips_;
  std::vector<LostSpan> lost_;
  FilterHealth before_;
};

/// One line for slips and one for losses, if there are any: when, in seconds since the start of the log.
[[nodiscard]] std::vector<std::string> describe(const PoseLosses& losses, Stamp start);

}  // namespace waymark
