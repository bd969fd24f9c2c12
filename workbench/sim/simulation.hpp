#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "workbench/logs/event_list.hpp"
#include "workbench/sim/camera_simulator.hpp"
#include "workbench/sim/drive.hpp"
#include "workbench/sim/options.hpp"

namespace waymark::sim {

/// A log that is made rather than read. Options and seed decide every bit of it: the places of the landmarks
/// and every error, so that runs over many seeds vary both. Events come in order of their stamps; all are
/// made at once but for images, which are rendered when they are asked for.
///
/// Odometry begins with the robot at rest at stamp 0. The sensor looks half a period later than its rate
/// would have it and so mostly between two odometry readings; scans that show nothing leave no event, as in a
/// log folder. Images are taken from stamp 0 on, after the truth of their stamp. Observations carry no
/// covariance: the noise stands in info().settings, together with wheels, mounts, limits and camera.
class Simulation final : public EventList {
 public:
  /// `name` becomes the log's. Refuses options that validate() refuses, and drives of more than ten million
  /// events. `threads` render images.
  static Result<std::unique_ptr<Simulation>> make(std::string name, const SimOptions& options,
                                                  std::uint64_t seed, int threads = 1);

  [[nodiscard]] Result<std::optional<Event>> next() override;

 private:
  Simulation(LogInfo info, std::vector<Event> events, std::unique_ptr<CameraSimulator> camera_simulator)
      : EventList(std::move(info), std::move(events)), camera_simulator_(std::move(camera_simulator)) {}

  std::unique_ptr<CameraSimulator> camera_simulator_;  ///< where there are images
};

}  // namespace waymark::sim
