#include "workbench/bags/odometry_messages.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace waymark::bag {
namespace {

constexpr std::array<std::string_view, 5> kTypes{"nav_msgs/Odometry", "sensor_msgs/JointState",
                                                 "geometry_msgs/TwistStamped", "geometry_msgs/Twist",
                                                 "geometry_msgs/PoseStamped"};

std::vector<std::string> pose_numbers(std::string_view path) {
  return below(
      path, {"position.x", "position.y", "orientation.x", "orientation.y", "orientation.z", "orientation.w"});
}

/// Of a message whose numbers 2 to 7 are those of pose_numbers(). The quaternion need not have length 1.
Result<Pose2> planar_pose(const MessageDecoder& message) {
  std::array<double, 6> n{};
  for (std::size_t i = 0; i < n.size(); ++i) n[i] = message.number(2 + i);
  const auto& [x_m, y_m, qx, qy, qz, qw] = n;
  if (!std::ranges::all_of(n, [](double value) { return std::isfinite(value); }))
    return Error{"its pose is not finite"};
  const double norm2 = qx * qx + qy * qy + qz * qz + qw * qw;
  if (norm2 < 1e-6) return Error{"its orientation is missing"};
  return Pose2{x_m, y_m, std::atan2(2.0 * (qw * qz + qx * qy), norm2 - 2.0 * (qy * qy + qz * qz))};
}

std::string_view pose_path(std::string_view type) { return type == kTypes[0] ? "pose.pose" : "pose"; }

Result<TopicReader> reader(const Topic& topic, const WantedFields& wanted, bool has_header,
                           std::function<Result<EventContent>(const MessageDecoder&)> content) {
  auto decoder = MessageDecoder::make(topic, wanted);
  if (!decoder) return decoder.error();
  return TopicReader{*std::move(decoder), has_header, std::move(content)};
}

Result<TopicReader> pose_reader(const Topic& topic) {
  return reader(topic, {after_stamp(pose_numbers(pose_path(topic.type))), {}}, true,
                [](const MessageDecoder& message) -> Result<EventContent> {
                  const auto pose = planar_pose(message);
                  if (!pose) return pose.error();
                  return EventContent(OdometryPose{*pose});
                });
}

Result<TopicReader> twist_reader(const Topic& topic) {
  const bool has_header = topic.type != "geometry_msgs/Twist";
  const WantedFields wanted{has_header ? after_stamp({"twist.linear.x", "twist.angular.z"})
                                       : std::vector<std::string>{"linear.x", "angular.z"},
                            {}};
  const std::size_t first = has_header ? 2 : 0;
  return reader(topic, wanted, has_header, [first](const MessageDecoder& message) -> Result<EventContent> {
    const Velocity velocity{message.number(first), message.number(first + 1)};
    if (!std::isfinite(velocity.v_mps) || !std::isfinite(velocity.w_radps))
      return Error{"its speed is not finite"};
    return EventContent(velocity);
  });
}

bool mentions(std::string_view name, std::string_view word) {
  const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  return !std::ranges::search(name, word, same).empty();
}

/// The angle of the joint of that name, or of the first that mentions the side and a wheel.
std::optional<double> joint_angle(const MessageDecoder& message, const std::string& joint,
                                  std::string_view side) {
  const auto names = message.texts(0);
  const auto angles = message.numbers(2);
  const auto found = std::ranges::find_if(names, [&](std::string_view name) {
    return joint.empty() ? mentions(name, side) && mentions(name, "wheel") : name == joint;
  });
  const auto place = static_cast<std::size_t>(found - names.begin());
  if (found == names.end() || place >= angles.size() || !std::isfinite(angles[place])) return std::nullopt;
  return angles[place];
}

Result<TopicReader> joint_reader(const Topic& topic, const WheelJoints& joints) {
  return reader(topic, {after_stamp({"position"}), {"name"}}, true,
                [joints](const MessageDecoder& message) -> Result<EventContent> {
                  const auto left_rad = joint_angle(message, joints.left, "left");
                  const auto right_rad = joint_angle(message, joints.right, "right");
                  if (left_rad && right_rad) return EventContent(WheelAngles{*left_rad, *right_rad});
                  return Error{
                      fmt::format("it has no positions of the joints {} and {} (input.left_joint and "
                                  "input.right_joint can name others)",
                                  joints.left.empty() ? "*left*wheel*" : joints.left,
                                  joints.right.empty() ? "*right*wheel*" : joints.right)};
                });
}

}  // namespace

int odometry_rank(std::string_view type) {
  const auto found = std::ranges::find(kTypes, type);
  return found == kTypes.end() ? -1 : static_cast<int>(found - kTypes.begin());
}

Result<TopicReader> odometry_reader(const Topic& topic, const WheelJoints& joints) {
  if (topic.type == "sensor_msgs/JointState") return joint_reader(topic, joints);
  if (topic.type.starts_with("geometry_msgs/Twist")) return twist_reader(topic);
  return pose_reader(topic);
}

Result<TopicReader> truth_reader(const Topic& topic) {
  auto poses = pose_reader(topic);
  if (!poses) return poses.error();
  poses->content = [](const MessageDecoder& message) -> Result<EventContent> {
    const auto pose = planar_pose(message);
    if (!pose) return pose.error();
    return EventContent(Truth{pose->x_m, pose->y_m, pose->theta_rad});
  };
  return poses;
}

}  // namespace waymark::bag
