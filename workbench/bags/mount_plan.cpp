#include "workbench/bags/mount_plan.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace waymark::bag {
namespace {

std::string_view last_name(std::string_view frame) { return frame.substr(frame.rfind('/') + 1); }

/// The robot's own frame and its usual names, as the tree has them.
std::vector<std::string> robot_frames(const FrameTree& frames, const RobotFrames& robot) {
  std::vector<std::string> all;
  for (const std::string& name : {robot.robot, std::string("base_footprint"), std::string("base_link")})
    if (!name.empty()) all.push_back(frames.resolve(name));
  return all;
}

/// By REP-105, or because the robot is seen to move in it.
bool is_fixed_in_world(const FrameTree& frames, const RobotFrames& robot, const std::string& frame) {
  constexpr std::array<std::string_view, 4> kWorld{"odom", "map", "world", "earth"};
  if (frame == robot.odometry || std::ranges::find(kWorld, last_name(frame)) != kWorld.end()) return true;
  return std::ranges::any_of(robot_frames(frames, robot),
                             [&](const std::string& each) { return frames.moves_in(each, frame); });
}

/// The one camera of the robot: the only leaf with an optical frame, else with a camera in its name.
std::optional<std::string> only_camera(const FrameTree& frames) {
  for (const char* word : {"optical", "camera"}) {
    std::vector<std::string> cameras;
    for (const std::string& leaf : frames.leaves())
      if (leaf.find(word) != std::string::npos) cameras.push_back(leaf);
    if (cameras.size() == 1) return cameras[0];
    if (!cameras.empty()) return std::nullopt;
  }
  return std::nullopt;
}

std::optional<Eigen::Isometry3d> place_on_robot(const FrameTree& frames, const RobotFrames& robot,
                                                const std::string& frame) {
  const auto on_ground = frames.find(frames.resolve("base_footprint"), frame);
  for (const std::string& each : robot_frames(frames, robot)) {
    auto T = frames.find(each, frame);
    if (T && on_ground) T->translation().z() = on_ground->translation().z();
    if (T) return T;
  }
  return std::nullopt;
}

}  // namespace

Result<MountPlan> plan_mount(const FrameTree& frames, const RobotFrames& robot, std::string frame,
                             const std::string& topic) {
  MountPlan plan{frames.resolve(frame), std::nullopt, {}};
  if (plan.frame.empty()) {
    const auto camera = only_camera(frames);
    plan.notes.push_back(
        camera
            ? fmt::format("{}: its messages are without a frame; the camera {} is taken", topic, *camera)
            : fmt::format("{}: its messages are without a frame, so that no transform tells where its camera "
                          "is",
                          topic));
    plan.frame = camera.value_or("");
  } else if (is_fixed_in_world(frames, robot, plan.frame)) {
    return Error{
        fmt::format("it tells places in the frame {}, in which the robot moves, and not in that of its "
                    "camera: they contain "
                    "the odometry; let the detector tell them in the camera's frame",
                    plan.frame)};
  }
  plan.T_robot_frame = place_on_robot(frames, robot, plan.frame);
  return plan;
}

}  // namespace waymark::bag
