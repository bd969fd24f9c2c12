#pragma once

#include <optional>
#include <vector>

#include "waymark/core/stamp.hpp"

namespace waymark {

/// A time without odometry.
struct OdometryGap {
  Stamp from;
  Stamp to;
  bool at_end = false;  ///< none came any more

  friend bool operator==(const OdometryGap&, const OdometryGap&) = default;
};

/// Finds where odometry is missing for longer than `max_hold`: between two readings, before the first, and
/// behind the last.
class OdometryGaps {
 public:
  explicit OdometryGaps(Duration max_hold) : max_hold_(max_hold) {}

  /// Something has a stamp, not before that of the last call. Before the first reading, the log begins with
  /// it.
  void see(Stamp stamp);
  /// A reading of the odometry.
  void see_reading(Stamp stamp);

  /// When odometry was last known: that of the last reading; before the first one, the begin of the log.
  [[nodiscard]] std::optional<Stamp> known() const { return known_; }

  /// So far, in the order of time.
  [[nodiscard]] std::vector<OdometryGap> all() const;

 private:
  Duration max_hold_;
  std::optional<Stamp> known_;
  Stamp newest_;
  std::vector<OdometryGap> closed_;
};

}  // namespace waymark
