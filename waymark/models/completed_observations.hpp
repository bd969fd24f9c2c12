#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "waymark/core/observation.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark {

/// Observations that all have a covariance: where one came without, it is the sensor's configured noise.
class CompletedObservations {
 public:
  /// `room` is how many may come at once before it allocates.
  explicit CompletedObservations(const LandmarkSensor& sensor, std::size_t room = 256) : sensor_(sensor) {
    completed_.reserve(room);
  }

  /// The observations themselves where all have one, else a copy. Valid until the next call.
  [[nodiscard]] std::span<const Observation> of(std::span<const Observation> observations);

 private:
  LandmarkSensor sensor_;
  std::vector<Observation> completed_;
};

}  // namespace waymark
