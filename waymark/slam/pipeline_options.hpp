#pragma once

#include "waymark/core/config.hpp"
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

struct PipelineOptions {
  double reorder_window_s = 0.5;  ///< how late an event may arrive and still be put in its place
  double max_hold_s = 2.0;        ///< how long the last speed is believed when odometry is missing
};

void describe(Schema& schema, PipelineOptions& options);

}  // namespace waymark
