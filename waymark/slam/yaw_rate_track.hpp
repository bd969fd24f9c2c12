#pragma once

#include <optional>
#include <utility>

#include "waymark/core/event.hpp"

namespace waymark {

/// The yaw rate of a gyro as a function of time: linear between two readings, held behind the last one for at
/// most `max_hold`.
class YawRateTrack {
 public:
  explicit YawRateTrack(Duration max_hold) : max_hold_(max_hold) {}

  void add(Stamp stamp, YawRate rate) { last_ = {stamp, rate.w_radps}; }

  /// How far the robot turned between two stamps that have no reading between them, counter-clockwise: the
  /// integral by the trapezoidal rule, which is exact here. Empty: not all of that time is covered by
  /// readings. `next` is the first reading at or after `to`, if it has arrived.
  [[nodiscard]] std::optional<double> turn_rad(Stamp from, Stamp to, const Event* next) const;

 private:
  using Reading = std::pair<Stamp, double>;

  [[nodiscard]] double rate_at(Stamp stamp, const std::optional<Reading>& next) const;

  Duration max_hold_;
  std::optional<Reading> last_;
};

}  // namespace waymark
