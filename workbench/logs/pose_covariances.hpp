#pragma once

#include <filesystem>

#include "waymark/core/result.hpp"
#include "waymark/core/trajectory.hpp"

namespace waymark {

/// The covariances of a trajectory, which the TUM format has no place for: one row
/// `stamp_s,sxx,sxy,sxt,syy,syt,stt` (m, rad) per pose that has one. Numbers read back to the last bit.
[[nodiscard]] Result<void> write_pose_covariances(const std::filesystem::path& path,
                                                  const Trajectory& trajectory);

/// Gives the poses of a trajectory the covariances of a file with the same stamps in the same order; poses
/// that the file leaves out stay without. Several poses of one stamp take theirs in turn.
[[nodiscard]] Result<void> read_pose_covariances(const std::filesystem::path& path, Trajectory& trajectory);

}  // namespace waymark
