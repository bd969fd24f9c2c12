#include "workbench/run/log_sample.hpp"

#include "waymark/slam/odometer.hpp"

namespace waymark {

void LogSample::add(const Event& event, const LandmarkSensor& sensor) {
  if (const auto* observed = std::get_if<Observations>(&event.content))
    return add(event.stamp, *observed, sensor);
  if (!measures_motion(event.content)) return;
  auto& kept = is_odometry(event.content) ? odometry : yaw_rates;
  if (kept.size() == kMost) return;
  const bool is_of_first_stream = kept.empty() || (kept.front().stream == event.stream &&
                                                   kept.front().content.index() == event.content.index());
  if (is_of_first_stream) kept.push_back(event);
}

void LogSample::add(Stamp stamp, std::span<const Observation> observed, const LandmarkSensor& sensor) {
  for (const Observation& each : observed)
    if (observations.size() < kMost) observations.push_back({stamp, each.id, rectify(sensor, each.value)});
}

}  // namespace waymark
