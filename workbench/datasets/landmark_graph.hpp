#pragma once

#include <filesystem>
#include <memory>

#include "waymark/core/result.hpp"

#include "workbench/logs/source.hpp"

namespace waymark {

/// Is it a graph of poses as text, of g2o or of PyFactorGraph: does its first line begin as one of theirs?
[[nodiscard]] bool is_landmark_graph(const std::filesystem::path& file);

/// Opens a graph of poses and landmarks as a log with identities: EDGE_SE2 or EDGE_SE3:QUAT between poses
/// that follow one another as OdometryPose; EDGE_SE2_XY, EDGE_SE3_XYZ, EDGE_BEARING_SE2_XY and EDGE_RANGE as
/// Observations with the noise that they state. Poses follow by their number. PyFactorGraph's files
/// have stamps and state the true poses and landmarks; those of g2o have neither (their vertices are a first
/// guess), and the stamp of a pose is its place in seconds. The frame of poses that move sideways is turned
/// until they move ahead. The mean noise of the odometry becomes settings. Refused: graphs without
/// observations of landmarks, with a gap in the odometry, or of poses that leave the plane. O(n log n).
[[nodiscard]] Result<std::unique_ptr<Source>> open_landmark_graph(const std::filesystem::path& file);

}  // namespace waymark
