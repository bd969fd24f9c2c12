#pragma once

#include <cstdint>
#include <vector>

#include "waymark/slam/gyro_findings.hpp"
#include "waymark/slam/odometry_gaps.hpp"
#include "waymark/slam/odometry_jumps.hpp"

namespace waymark {

/// Counts of events and observations that were not used, by reason.
struct PipelineCounts {
  std::int64_t events = 0;
  std::int64_t observations = 0;
  std::int64_t late = 0;             ///< stamped before what was already processed
  std::int64_t unusable = 0;         ///< not finite or outside the sensor's limits
  std::int64_t wrong_kind = 0;       ///< lacks what --observe asks for
  std::int64_t other_odometry = 0;   ///< of a second kind or a second device
  std::int64_t other_robots = 0;     ///< events of another robot than the first event's
  std::int64_t robots_seen = 0;      ///< observations of other robots, which are no landmarks
  std::int64_t before_odometry = 0;  ///< observed before the first odometry: used, at the start pose
  std::int64_t images = 0;           ///< looked into
  std::int64_t outlines = 0;         ///< of these what another program looked into: corners of markers
  std::int64_t misfits = 0;          ///< images without pixels or of another size than the camera's
  std::int64_t repeats = 0;          ///< images with the stamp or all the pixels of the one before
  std::vector<OdometryGap> odometry_gaps;
  OdometryJumps odometry_jumps;
  GyroFindings gyro;
};

}  // namespace waymark
