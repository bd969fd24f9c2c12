#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "waymark/core/source.hpp"
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
class Simulation final : public Source {
 public:
  /// `name` becomes the log's. Refuses options that validate() refuses, and drives of more than ten million
  /// events.
  static Result<std::unique_ptr<Simulation>> make(std::string name, const SimOptions& options,
                                                  std::uint64_t seed);

  [[nodiscard]] const LogInfo& info() const override { return info_; }
  [[nodiscard]] Result<std::optional<Event>> next() override;
  [[nodiscard]] double progress() const override;

 private:
  Simulation(LogInfo info, std::vector<Event> events) : info_(std::move(info)), events_(std::move(events)) {}

  LogInfo info_;
  std::vector<Event> events_;
  std::size_t next_ = 0;
};

}  // namespace waymark::sim
