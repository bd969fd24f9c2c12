#include "workbench/bags/detection_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace waymark::bag {
namespace {

struct DetectionType {
  std::string_view type;
  std::string_view id;
  std::string_view position;
};

/// Where the messages in common use keep what is wanted. A type may have changed its fields over the years:
/// the definition in the bag decides which row holds.
constexpr std::array kDetectionTypes{
    DetectionType{"fiducial_msgs/FiducialTransformArray", "transforms.fiducial_id",
                  "transforms.transform.translation"},
    DetectionType{"aruco_msgs/MarkerArray", "markers.id", "markers.pose.pose.position"},
    DetectionType{"aruco_opencv_msgs/ArucoDetection", "markers.marker_id", "markers.pose.position"},
    DetectionType{"ros2_aruco_interfaces/ArucoMarkers", "marker_ids", "poses.position"},
    DetectionType{"ar_track_alvar_msgs/AlvarMarkers", "markers.id", "markers.pose.pose.position"},
    DetectionType{"apriltag_ros/AprilTagDetectionArray", "detections.id",
                  "detections.pose.pose.pose.position"},
    DetectionType{"apriltag_ros/AprilTagDetectionArray", "detections.id", "detections.pose.pose.position"},
    DetectionType{"apriltags_ros/AprilTagDetectionArray", "detections.id", "detections.pose.pose.position"},
    DetectionType{"isaac_ros_apriltag_interfaces/AprilTagDetectionArray", "detections.id",
                  "detections.pose.pose.pose.position"}};

std::optional<std::int32_t> identity_of(double number) {
  constexpr double kLargestId = std::numeric_limits<std::int32_t>::max();
  const bool is_one = number >= 0.0 && number <= kLargestId;
  return is_one ? std::optional(static_cast<std::int32_t>(number)) : std::nullopt;
}

class ToObservations {
 public:
  explicit ToObservations(const CameraMount& mount)
      : R_sensor_camera_(
            Eigen::AngleAxisd(-to_radians(mount.yaw_deg), Eigen::Vector3d::UnitZ()).toRotationMatrix() *
            mount.R_robot_camera()) {}

  Result<EventContent> operator()(const MessageDecoder& message) const {
    const auto ids = message.numbers(2), x = message.numbers(3), y = message.numbers(4),
               z = message.numbers(5);
    if (ids.size() != x.size() || x.size() != y.size() || y.size() != z.size())
      return Error{"its numbers of identities and poses differ"};
    Observations observations;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const Eigen::Vector3d p_sensor = R_sensor_camera_ * Eigen::Vector3d(x[i], y[i], z[i]);
      const auto id = identity_of(ids[i]);
      if (!id || !p_sensor.allFinite()) continue;
      observations.push_back({LandmarkId{LandmarkId::Family::kMarker, *id},
                              RangeBearing{p_sensor.head<2>().norm(), std::atan2(p_sensor.y(), p_sensor.x())},
                              std::nullopt});
    }
    return EventContent(std::move(observations));
  }

 private:
  Eigen::Matrix3d R_sensor_camera_;
};

constexpr std::string_view kOutlines = "apriltag_msgs/AprilTagDetectionArray";

/// libapriltag, whose corners these are, begins at the lower left, goes counter-clockwise, and counts from
/// the edge of the first pixel.
Result<EventContent> to_outlines(const MessageDecoder& message) {
  const auto ids = message.numbers(2), x = message.numbers(3), y = message.numbers(4);
  if (x.size() != 4 * ids.size() || y.size() != x.size())
    return Error{"it does not have four corners for each identity"};
  MarkerOutlines outlines;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto id = identity_of(ids[i]);
    if (!id) continue;
    const auto corner = [&](std::size_t k) {
      return Eigen::Vector2d(x[4 * i + k] - 0.5, y[4 * i + k] - 0.5);
    };
    outlines.push_back({*id, {corner(3), corner(2), corner(1), corner(0)}});
  }
  return EventContent(std::move(outlines));
}

}  // namespace

bool is_detection(std::string_view type) {
  return std::ranges::find(kDetectionTypes, type, &DetectionType::type) != kDetectionTypes.end();
}

Result<TopicReader> detection_reader(const Topic& topic, const CameraMount& mount) {
  Error error{fmt::format("{}: {} is not a supported type of marker detections", topic.name, topic.type)};
  for (const auto& [type, id, position] : kDetectionTypes) {
    if (type != topic.type) continue;
    auto numbers = below(position, {"x", "y", "z"});
    numbers.insert(numbers.begin(), std::string(id));
    auto decoder = MessageDecoder::make(topic, {after_stamp(std::move(numbers)), {}});
    if (decoder) return TopicReader{*std::move(decoder), true, ToObservations(mount)};
    error = decoder.error();
  }
  return error;
}

bool is_outline(std::string_view type) { return type == kOutlines; }

Result<TopicReader> outline_reader(const Topic& topic) {
  auto decoder = MessageDecoder::make(
      topic, {after_stamp({"detections.id", "detections.corners.x", "detections.corners.y"}), {}});
  if (!decoder) return decoder.error();
  return TopicReader{*std::move(decoder), true, to_outlines};
}

std::string outline_dictionary(const Topic& topic, std::string_view bytes) {
  auto message = MessageDecoder::make(topic, {{}, {"detections.family"}});
  if (!message || !message->decode(bytes) || !message->text(0).starts_with("tag")) return "";
  return "apriltag_" + std::string(message->text(0).substr(3));
}

}  // namespace waymark::bag
