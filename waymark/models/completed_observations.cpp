#include "waymark/models/completed_observations.hpp"

#include <algorithm>

namespace waymark {

std::span<const Observation> CompletedObservations::of(std::span<const Observation> observations) {
  if (std::ranges::all_of(observations, [](const Observation& each) { return each.covariance.has_value(); }))
    return observations;
  completed_.assign(observations.begin(), observations.end());
  for (Observation& each : completed_)
    if (!each.covariance) each.covariance = noise_covariance(sensor_, each.value);
  return completed_;
}

}  // namespace waymark
