#pragma once

#include <filesystem>
#include <memory>

#include "waymark/core/result.hpp"

#include "workbench/logs/source.hpp"

namespace waymark {

/// Is it the graph of the Victoria Park log, a .txt file that begins with ODOMETRY?
[[nodiscard]] bool is_victoria_park_graph(const std::filesystem::path& file);

/// Opens the pose graph that was made of that log by hand, with 151 trees that are known by number:
/// OdometryPose, and Observations as from the laser. It has no times. Where the log lies beside it, each pose
/// has the time of the scan at which the vehicle had gone as far, and Truth is that of the log; else poses
/// are 0.2 s apart.
[[nodiscard]] Result<std::unique_ptr<Source>> open_victoria_park_graph(const std::filesystem::path& file);

}  // namespace waymark
