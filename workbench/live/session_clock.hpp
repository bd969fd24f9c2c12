#pragma once

#include <chrono>

#include "waymark/core/stamp.hpp"

namespace waymark::live {

/// The time of a session: it begins at an origin and never steps, whatever is done to the wall clock
/// meanwhile. On a robot the origin is Unix time; a log that is replayed has its own, and may run faster.
class SessionClock {
 public:
  SessionClock() : SessionClock(unix_now(), 1.0) {}
  SessionClock(Stamp origin, double speed)
      : origin_(origin), speed_(speed), start_(std::chrono::steady_clock::now()) {}

  [[nodiscard]] Stamp now() const {
    const Duration elapsed = std::chrono::steady_clock::now() - start_;
    return origin_ + Duration(static_cast<Duration::rep>(speed_ * static_cast<double>(elapsed.count())));
  }

  /// When it will be that time.
  [[nodiscard]] std::chrono::steady_clock::time_point when(Stamp stamp) const {
    const auto since_origin = static_cast<double>((stamp - origin_).count());
    return start_ + Duration(static_cast<Duration::rep>(since_origin / speed_));
  }

  /// How much of the session's time passes in a real time.
  [[nodiscard]] Duration span(Duration real) const {
    return Duration(static_cast<Duration::rep>(speed_ * static_cast<double>(real.count())));
  }

  [[nodiscard]] static Stamp unix_now() {
    return {std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch())};
  }

 private:
  Stamp origin_;
  double speed_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace waymark::live
