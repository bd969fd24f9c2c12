#include "workbench/bags/detection_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "workbench/bags/identities.hpp"

namespace waymark::bag {
namespace {

struct DetectionType {
  std::string_view type;
  std::string_view header;
  std::string_view id;  ///< a number or a text
  std::string_view position;
  bool is_polar = false;  ///< `position` has range and bearing, not x, y and z
};

/// Where the messages in common use keep what is wanted. A type may have changed its fields over the years:
/// its definition decides which row holds.
constexpr std::array kDetectionTypes{
    DetectionType{"fiducial_msgs/FiducialTransformArray", "header", "transforms.fiducial_id",
                  "transforms.transform.translation"},
    DetectionType{"aruco_msgs/MarkerArray", "header", "markers.id", "markers.pose.pose.position"},
    DetectionType{"aruco_opencv_msgs/ArucoDetection", "header", "markers.marker_id", "markers.pose.position"},
    DetectionType{"ros2_aruco_interfaces/ArucoMarkers", "header", "marker_ids", "poses.position"},
    DetectionType{"ar_track_alvar_msgs/AlvarMarkers", "header", "markers.id", "markers.pose.pose.position"},
    DetectionType{"apriltag_ros/AprilTagDetectionArray", "header", "detections.id",
                  "detections.pose.pose.pose.position"},
    DetectionType{"apriltag_ros/AprilTagDetectionArray", "header", "detections.id",
                  "detections.pose.pose.position"},
    DetectionType{"apriltags2_ros/AprilTagDetectionArray", "header", "detections.id",
                  "detections.pose.pose.pose.position"},
    DetectionType{"apriltags_ros/AprilTagDetectionArray", "header", "detections.id",
                  "detections.pose.pose.position"},
    DetectionType{"apriltags_ros/AprilTagDetectionArray", "detections.pose.header", "detections.id",
                  "detections.pose.pose.position"},
    DetectionType{"isaac_ros_apriltag_interfaces/AprilTagDetectionArray", "header", "detections.id",
                  "detections.pose.pose.pose.position"},
    DetectionType{"apriltag_msgs/AprilTagDetectionArray", "header", "detections.id",
                  "detections.pose.pose.pose.position"},
    DetectionType{"apriltag_msgs/AprilTagDetectionArray", "header", "detections.id",
                  "detections.pose.pose.position"},
    DetectionType{"apriltag_msgs/AprilTagDetectionArray", "header", "detections.id",
                  "detections.pose.position"},
    DetectionType{"apriltag_msgs/AprilTagDetectionArray", "header", "detections.id",
                  "detections.tag_transform.transform.translation"},
    DetectionType{"cartographer_ros_msgs/LandmarkList", "header", "landmarks.id",
                  "landmarks.tracking_from_landmark_transform.position"},
    DetectionType{"landmark_msgs/LandmarkArray", "header", "landmarks.id", "landmarks", true},
    DetectionType{"vision_msgs/Detection3DArray", "header", "detections.results.hypothesis.class_id",
                  "detections.results.pose.pose.position"},
    DetectionType{"vision_msgs/Detection3DArray", "header", "detections.results.id",
                  "detections.results.pose.pose.position"}};

/// Numbers 0 and 1 are the stamp, 2 is the identity where it is a number, 3 to 5 are the position; text 0 is
/// the identity where it is a text.
std::vector<WantedFields> choices_of(std::string_view type) {
  std::vector<WantedFields> choices;
  for (const DetectionType& row : kDetectionTypes) {
    if (row.type != type) continue;
    auto position = below(row.position, {"x", "y", "z"});
    if (row.is_polar)
      position = {fmt::format("{}.range", row.position), fmt::format("{}.bearing", row.position), ""};
    for (const bool is_text : {false, true}) {
      const std::string id(row.id);
      WantedFields wanted{below(row.header, {"stamp.sec", "stamp.nanosec"}), {is_text ? id : ""}};
      wanted.numbers.push_back(is_text ? "" : id);
      std::ranges::copy(position, std::back_inserter(wanted.numbers));
      choices.push_back(std::move(wanted));
    }
  }
  return choices;
}

/// The identities of one topic, and what had to be left out.
struct Told {
  Identities identities;
  std::int64_t not_finite = 0;

  /// Of observation i of a message that has choices_of() or those of outlines.
  [[nodiscard]] std::optional<std::int32_t> identity(const MessageDecoder& message, std::size_t i) {
    const auto numbers = message.numbers(2);
    return i < numbers.size() ? identities.of_number(numbers[i]) : identities.of_text(message.texts(0)[i]);
  }

  [[nodiscard]] std::vector<std::string> notes(const std::string& topic) const {
    std::vector<std::string> lines;
    if (identities.unusable() > 0)
      lines.push_back(fmt::format(
          "{}: {} observations without a usable identity left out, the first with {}; usable are whole "
          "numbers from 0 to 2147483647 and texts with such a number of their own",
          topic, identities.unusable(), identities.example()));
    if (not_finite > 0)
      lines.push_back(
          fmt::format("{}: {} observations whose position is not finite left out", topic, not_finite));
    return lines;
  }
};

TopicReader reader_with(MessageDecoder decoder, const Topic& topic, std::shared_ptr<Told> told,
                        std::function<Result<EventContent>(const MessageDecoder&)> content) {
  return {std::move(decoder), true, std::move(content),
          [told = std::move(told), name = topic.name] { return told->notes(name); }};
}

class ToObservations {
 public:
  ToObservations(const CameraMount& mount, bool is_polar, std::shared_ptr<Told> told)
      : R_sensor_camera_(
            Eigen::AngleAxisd(-to_radians(mount.yaw_deg), Eigen::Vector3d::UnitZ()).toRotationMatrix() *
            mount.R_robot_camera()),
        is_polar_(is_polar),
        told_(std::move(told)) {}

  Result<EventContent> operator()(const MessageDecoder& message) const {
    const std::size_t count = std::max(message.numbers(2).size(), message.texts(0).size());
    for (std::size_t column = 3; column < (is_polar_ ? 5 : 6); ++column)
      if (message.numbers(column).size() != count) return Error{"its numbers of identities and poses differ"};
    Observations observations;
    for (std::size_t i = 0; i < count; ++i) {
      const auto id = told_->identity(message, i);
      const Eigen::Vector3d p_sensor = R_sensor_camera_ * position(message, i);
      if (!p_sensor.allFinite()) ++told_->not_finite;
      if (!id || !p_sensor.allFinite()) continue;
      observations.push_back({LandmarkId{LandmarkId::Family::kMarker, *id},
                              RangeBearing{p_sensor.head<2>().norm(), std::atan2(p_sensor.y(), p_sensor.x())},
                              std::nullopt});
    }
    return EventContent(std::move(observations));
  }

 private:
  /// In the axes of the message's frame. A bearing counts from the x axis of a frame whose z axis points up,
  /// and from the axis of a camera, to the left.
  [[nodiscard]] Eigen::Vector3d position(const MessageDecoder& message, std::size_t i) const {
    const double x = message.numbers(3)[i], y = message.numbers(4)[i];
    if (!is_polar_) return {x, y, message.numbers(5)[i]};
    const double ahead_m = x * std::cos(y), left_m = x * std::sin(y);
    const bool is_upright = R_sensor_camera_(2, 2) > std::sqrt(0.5);
    return is_upright ? Eigen::Vector3d(ahead_m, left_m, 0.0) : Eigen::Vector3d(-left_m, 0.0, ahead_m);
  }

  Eigen::Matrix3d R_sensor_camera_;
  bool is_polar_;
  std::shared_ptr<Told> told_;
};

using Corners = std::array<Eigen::Vector2d, 4>;

/// Numbers 3 and 4 are x and y of four corners of each tag. libapriltag, whose corners these are, begins at
/// the lower left, goes counter-clockwise, and counts from the edge of the first pixel.
std::optional<Corners> tag_corners(const MessageDecoder& message, std::size_t i) {
  const auto x = message.numbers(3), y = message.numbers(4);
  if (x.size() != 4 * message.numbers(2).size() || y.size() != x.size()) return std::nullopt;
  const auto corner = [&](std::size_t k) { return Eigen::Vector2d(x[4 * i + k] - 0.5, y[4 * i + k] - 0.5); };
  return Corners{corner(3), corner(2), corner(1), corner(0)};
}

/// Numbers 3 to 6 are x, 7 to 10 y of the corners, as OpenCV finds them: in the order of MarkerOutline.
std::optional<Corners> fiducial_corners(const MessageDecoder& message, std::size_t i) {
  const auto corner = [&](std::size_t k) {
    return Eigen::Vector2d(message.numbers(3 + k)[i], message.numbers(7 + k)[i]);
  };
  return Corners{corner(0), corner(1), corner(2), corner(3)};
}

constexpr std::string_view kTags = "apriltag_msgs/AprilTagDetectionArray";
constexpr std::string_view kFiducials = "fiducial_msgs/FiducialArray";

WantedFields wanted_outlines(std::string_view type) {
  WantedFields wanted{after_stamp({"detections.id", "detections.corners.x", "detections.corners.y"}), {}};
  if (type == kTags) return wanted;
  wanted.numbers = after_stamp({"fiducials.fiducial_id"});
  std::ranges::move(below("fiducials", {"x0", "x1", "x2", "x3", "y0", "y1", "y2", "y3"}),
                    std::back_inserter(wanted.numbers));
  return wanted;
}

}  // namespace

int detection_rank(const Topic& topic) {
  const auto row = std::ranges::find(kDetectionTypes, topic.type, &DetectionType::type);
  const bool is_one = row != kDetectionTypes.end() &&
                      (topic.type != kTags || MessageDecoder::make_any(topic, choices_of(topic.type)).ok());
  return is_one ? static_cast<int>(row - kDetectionTypes.begin()) : -1;
}

Result<TopicReader> detection_reader(const Topic& topic, const CameraMount& mount) {
  const auto choices = choices_of(topic.type);
  if (choices.empty())
    return Error{fmt::format("{}: {} is not a supported type of marker detections", topic.name, topic.type)};
  auto decoder = MessageDecoder::make_any(topic, choices);
  if (!decoder) return decoder.error();
  const bool is_polar = choices[0].numbers.back().empty();
  const auto told = std::make_shared<Told>();
  return reader_with(*std::move(decoder), topic, told, ToObservations(mount, is_polar, told));
}

bool is_outline(const Topic& topic) {
  return topic.type == kFiducials || (topic.type == kTags && detection_rank(topic) < 0);
}

bool outlines_are_rectified(std::string_view type) { return type == kTags; }

Result<TopicReader> outline_reader(const Topic& topic) {
  auto decoder = MessageDecoder::make(topic, wanted_outlines(topic.type));
  if (!decoder) return decoder.error();
  const auto told = std::make_shared<Told>();
  const auto corners_of = topic.type == kTags ? tag_corners : fiducial_corners;
  return reader_with(*std::move(decoder), topic, told,
                     [told, corners_of](const MessageDecoder& message) -> Result<EventContent> {
                       MarkerOutlines outlines;
                       for (std::size_t i = 0; i < message.numbers(2).size(); ++i) {
                         const auto corners = corners_of(message, i);
                         if (!corners) return Error{"it does not have four corners for each identity"};
                         const bool is_finite = std::ranges::all_of(
                             *corners, [](const Eigen::Vector2d& corner) { return corner.allFinite(); });
                         const auto id = told->identity(message, i);
                         if (!is_finite) ++told->not_finite;
                         if (id && is_finite) outlines.push_back({*id, *corners});
                       }
                       return EventContent(std::move(outlines));
                     });
}

std::string outline_dictionary(const Topic& topic, std::string_view bytes) {
  auto message = MessageDecoder::make(topic, {{}, {"detections.family"}});
  if (!message || !message->decode(bytes) || !message->text(0).starts_with("tag")) return "";
  return "apriltag_" + std::string(message->text(0).substr(3));
}

}  // namespace waymark::bag
