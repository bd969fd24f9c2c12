#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "waymark/core/stamp.hpp"

namespace waymark::live {

/// Maps the clock of a device to that of the session. What a device stamped arrives later by a delay that
/// varies, but is hardly ever shorter than its least: the difference of both clocks is the lower envelope of
/// arrival - device stamp (Moon, Skelly, Towsley 1999), here the least of the last 20 s, so that clocks may
/// drift. A burst after a stall then keeps its spacing, and a late reader shifts nothing.
///
/// A device whose stamps are within a second of the session's clock shares it: its stamps are taken as they
/// are. A clock that steps by more than a second is mapped anew, and counted.
class ClockMap {
 public:
  /// The moment, by the session's clock, of what the device stamped and what arrived then: never later than
  /// that, nor earlier than the one before. O(1).
  [[nodiscard]] Stamp map(Duration device, Stamp arrived);

  [[nodiscard]] int steps() const { return steps_; }

 private:
  static constexpr std::size_t kBuckets = 10;

  [[nodiscard]] bool has_stepped(Duration offset, Stamp arrived);
  void forget(Stamp arrived);
  void begin(Duration offset, Stamp arrived);
  [[nodiscard]] Duration least_offset() const;

  std::array<std::optional<Duration>, kBuckets> least_;  // of 2 s each
  std::size_t bucket_ = 0;
  Stamp bucket_start_;
  std::optional<Stamp> late_since_;  // that arrivals are later than by a delay
  std::optional<Stamp> last_;        // that was given
  bool shared_ = false;
  int steps_ = 0;
};

}  // namespace waymark::live
