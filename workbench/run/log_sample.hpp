#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "waymark/core/event.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark {

/// Odometry, gyro and observations of a log, by which it is judged whether its numbers can be right.
struct LogSample {
  struct Observed {
    Stamp stamp;
    std::optional<LandmarkId> id;
    Measurement value;  ///< freed from the sensor's known errors
  };

  /// Of each kind: the first half an hour and more of a log.
  static constexpr std::size_t kMost = 50'000;

  std::vector<Event> odometry;   ///< of the first stream, in the log's order
  std::vector<Event> yaw_rates;  ///< likewise
  std::vector<Observed> observations;

  /// Takes what an event has of these, as far as there is room.
  void add(const Event& event, const LandmarkSensor& sensor);
  void add(Stamp stamp, std::span<const Observation> observed, const LandmarkSensor& sensor);
};

}  // namespace waymark
