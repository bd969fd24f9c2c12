#pragma once

#include "waymark/models/landmark_sensor.hpp"

namespace waymark {

/// Kind of observations to use.
enum class Observe { kRangeBearing, kRange, kBearing, kPixel, kMarkers };

/// Whether every observation has a range and a bearing.
[[nodiscard]] constexpr bool observes_position(Observe observe) {
  return observe == Observe::kRangeBearing || observe == Observe::kMarkers;
}

/// Whether it shows how large the world is: ranges whose scale is known.
[[nodiscard]] bool observes_scale(Observe observe, const SensorErrors& errors);

}  // namespace waymark
