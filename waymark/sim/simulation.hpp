#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "waymark/core/event_list.hpp"
#include "waymark/sim/drive.hpp"
#include "waymark/sim/options.hpp"

namespace waymark::sim {

/// A log that is made rather than read. Options and seed decide every bit of it: the places of the landmarks
/// and every error, so that runs over many seeds vary both. All events are made at once, in order of their
/// stamps.
///
/// Odometry begins with the robot at rest at stamp 0. The sensor looks half a period later than its rate
/// would have it and so mostly between two odometry readings; scans that show nothing leave no event, as in a
/// log folder. Observations carry no covariance: the noise stands in info().settings, together with wheels,
/// mount and limits.
class Simulation final : public EventList {
 public:
  /// `name` becomes the log's. Refuses options that validate() refuses, and drives of more than ten million
  /// events.
  static Result<std::unique_ptr<Simulation>> make(std::string name, const SimOptions& options,
                                                  std::uint64_t seed);

 private:
  Simulation(LogInfo info, std::vector<Event> events) : EventList(std::move(info), std::move(events)) {}
};

}  // namespace waymark::sim
