#pragma once

#include "waymark/models/landmark_sensor.hpp"

namespace waymark {

/// Which part of what the log holds is used.
enum class Observe { kRangeBearing, kRange, kBearing, kPixel, kMarkers };

/// Whether every sighting has a range and a bearing.
[[nodiscard]] constexpr bool tells_place(Observe observe) {
  return observe == Observe::kRangeBearing || observe == Observe::kMarkers;
}

/// Whether it shows how large the world is: ranges whose scale is known.
[[nodiscard]] bool tells_size(Observe observe, const SensorErrors& errors);

}  // namespace waymark
