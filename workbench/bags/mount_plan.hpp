#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "waymark/core/result.hpp"

#include "workbench/bags/frame_tree.hpp"

namespace waymark::bag {

/// The frames that a bag's odometry names; empty where it does not.
struct RobotFrames {
  std::string robot;     ///< child_frame_id: what moves
  std::string odometry;  ///< frame_id: in which it does
};

/// Where a camera or a detector is on the robot.
struct MountPlan {
  std::string frame;                               ///< in which it tells places
  std::optional<Eigen::Isometry3d> T_robot_frame;  ///< z above the ground; nothing where no transform says
  std::vector<std::string> notes;
};

/// Follows transforms from `frame`, which messages of `topic` name, up to the robot: the child frame of its
/// odometry, else base_footprint, base_link. The height is that above base_footprint where that is known. For
/// messages without a frame the one camera counts that there is. An error: places are told in a frame in
/// which the robot moves, so that they contain its odometry, or somebody's map.
[[nodiscard]] Result<MountPlan> plan_mount(const FrameTree& frames, const RobotFrames& robot,
                                           std::string frame, const std::string& topic);

}  // namespace waymark::bag
