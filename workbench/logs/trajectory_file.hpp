#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "waymark/core/result.hpp"
#include "waymark/core/stamp.hpp"

namespace waymark {

/// A pose in space at one moment: T_file_body, m.
struct SpacePose {
  Stamp stamp;
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  ///< of unit length
};

/// In the order of time.
using SpacePath = std::vector<SpacePose>;

/// A path as another program wrote it.
struct TrajectoryFile {
  SpacePath path;
  std::string format;              ///< "TUM", "EuRoC" or "KITTI"
  bool has_stamps = true;          ///< false: rows have none, and are taken as a second apart
  std::vector<std::string> notes;  ///< what was guessed or left out, one line each, with the file's name
};

/// Reads a path of rows of numbers between blanks, commas or semicolons. # begins a comment, and a first line
/// of words is passed over. By their number of columns rows are of
///   TUM:   stamp_s tx ty tz qx qy qz qw, quaternions of any length; further columns (covariances,
///   velocities)
///          are left out with a note;
///   EuRoC: the same with the quaternion as qw qx qy qz: where the line of names says so, or where rows
///          between commas have stamps in nanoseconds;
///   KITTI: the 3 x 4 matrix [R t] row by row, without stamps.
/// Stamps may be in other units than seconds (unit_of()); must not go back, and may repeat. Both are noted.
/// Errors name file and line.
[[nodiscard]] Result<TrajectoryFile> read_trajectory(const std::filesystem::path& path);

}  // namespace waymark
