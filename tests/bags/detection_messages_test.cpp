#include "workbench/bags/detection_messages.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "bags/filled_message.hpp"

namespace waymark::bag {
namespace {

using test::FilledMessage;
using test::Values;
using test::Wire;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::array kDetections{"fiducial_msgs/FiducialTransformArray",
                                 "aruco_msgs/MarkerArray",
                                 "aruco_opencv_msgs/ArucoDetection",
                                 "ros2_aruco_interfaces/ArucoMarkers",
                                 "ar_track_alvar_msgs/AlvarMarkers",
                                 "apriltag_ros/AprilTagDetectionArray",
                                 "apriltags2_ros/AprilTagDetectionArray",
                                 "apriltags_ros/AprilTagDetectionArray",
                                 "isaac_ros_apriltag_interfaces/AprilTagDetectionArray",
                                 "cartographer_ros_msgs/LandmarkList",
                                 "landmark_msgs/LandmarkArray",
                                 "vision_msgs/Detection3DArray"};

/// Two markers, 7 and 8, 1 m and 2 m to the right of a camera's axis and 2 m ahead; the same for ranges and
/// bearings.
Values two_markers() {
  const auto number = [](const std::string& path, std::uint32_t element) {
    const std::string name = path.substr(path.rfind('.') + 1);
    const double right_m = 1.0 + element, ahead_m = 2.0;
    if (name == "sec") return 100.0;
    if (name == "nanosec") return 5.0;
    if (name == "id" || name == "fiducial_id" || name.starts_with("marker_id")) return 7.0 + element;
    if (name == "range") return std::hypot(right_m, ahead_m);
    if (name == "bearing") return std::atan2(-right_m, ahead_m);
    if (path.ends_with("position.x") || path.ends_with("translation.x")) return right_m;
    if (path.ends_with("position.y") || path.ends_with("translation.y")) return -3.0;
    if (path.ends_with("position.z") || path.ends_with("translation.z")) return ahead_m;
    return 0.0;
  };
  return {number, [](const std::string& path, std::uint32_t element) {
            const bool is_identity = path.ends_with(".id") || path.ends_with(".class_id");
            return is_identity ? "tag_" + std::to_string(7 + element) : std::string("camera");
          }};
}

Topic topic_of(std::string type, Encoding encoding, std::string definition = {}) {
  return {
      .name = "/seen", .type = std::move(type), .encoding = encoding, .definition = std::move(definition)};
}

Observations observations_of(TopicReader& reader, const std::string& bytes) {
  const auto done = reader.decoder.decode(bytes);
  EXPECT_TRUE(done.ok()) << done.error().message;
  const auto content = done ? reader.content(reader.decoder) : Result<EventContent>(done.error());
  return content ? std::get<Observations>(*content) : Observations{};
}

void expect_two_markers(const Observations& seen, const std::string& of) {
  ASSERT_EQ(seen.size(), 2U) << of;
  for (std::size_t i = 0; i < 2; ++i) {
    const double right_m = 1.0 + static_cast<double>(i);
    const auto& [range_m, bearing_rad] = std::get<RangeBearing>(seen[i].value);
    EXPECT_EQ(seen[i].id->number, 7 + static_cast<int>(i)) << of;
    EXPECT_NEAR(range_m, std::hypot(right_m, 2.0), 1e-6) << of;
    EXPECT_NEAR(bearing_rad, std::atan2(-right_m, 2.0), 1e-6) << of;
  }
}

TEST(DetectionMessages, OfAllTypesAreReadWithoutADefinition) {
  for (const char* type : kDetections)
    for (const Encoding encoding : {Encoding::kRos1, Encoding::kCdr}) {
      const Topic bare = topic_of(type, encoding);
      ASSERT_GE(detection_rank(bare), 0) << type;
      const auto layouts = layouts_of(bare);
      ASSERT_TRUE(layouts.ok()) << layouts.error().message;
      for (const Layout& layout : *layouts) {
        auto reader = detection_reader(bare, {});
        ASSERT_TRUE(reader.ok()) << reader.error().message;
        Values none = two_markers();
        none.elements = 0;
        EXPECT_THAT(observations_of(*reader, FilledMessage(encoding, none).write(layout.fields)), IsEmpty());
        expect_two_markers(
            observations_of(*reader, FilledMessage(encoding, two_markers()).write(layout.fields)), type);
        EXPECT_EQ(reader->stamp(), Stamp{std::chrono::seconds(100) + Duration(5)}) << type;
        EXPECT_THAT(reader->notes(), IsEmpty()) << type;
      }
    }
}

TEST(DetectionMessages, OfApriltagMsgsHavePlacesWhereTheirDefinitionSaysSo) {
  constexpr const char* kArray =
      "std_msgs/Header header\nAprilTagDetection[] detections\n========\nMSG: "
      "apriltag_msgs/AprilTagDetection\n";
  for (const char* fields :
       {"int32 id\nfloat64 size\ngeometry_msgs/PoseWithCovarianceStamped pose\n",
        "string family\nint32 id\nfloat32 decision_margin\nPoint[4] corners\ngeometry_msgs/PoseStamped "
        "pose\n",
        "string family\nint32 id\nfloat64[9] homography\ngeometry_msgs/Pose pose\n",
        "string family\nint32 id\nPoint centre\ngeometry_msgs/TransformStamped tag_transform\n"}) {
    const Topic tags =
        topic_of("apriltag_msgs/AprilTagDetectionArray", Encoding::kCdr, std::string(kArray) + fields);
    EXPECT_GE(detection_rank(tags), 0) << fields;
    EXPECT_FALSE(is_outline(tags)) << fields;
    auto reader = detection_reader(tags, {});
    ASSERT_TRUE(reader.ok()) << reader.error().message;
    const auto layouts = layouts_of(tags);
    expect_two_markers(
        observations_of(*reader, FilledMessage(Encoding::kCdr, two_markers()).write(layouts->front().fields)),
        fields);
  }
  const Topic corners = topic_of("apriltag_msgs/AprilTagDetectionArray", Encoding::kCdr);
  EXPECT_LT(detection_rank(corners), 0);
  EXPECT_TRUE(is_outline(corners));
}

TEST(DetectionMessages, CountBearingsFromTheXAxisOfAnUprightFrame) {
  // The axes of this mount are those of the robot, and the sensor's axis is then the robot's left.
  const CameraMount upright{.pitch_deg = -90.0, .yaw_deg = 90.0};
  auto reader = detection_reader(topic_of("landmark_msgs/LandmarkArray", Encoding::kCdr), upright);
  ASSERT_TRUE(reader.ok());
  const auto layouts = layouts_of(topic_of("landmark_msgs/LandmarkArray", Encoding::kCdr));
  const auto seen =
      observations_of(*reader, FilledMessage(Encoding::kCdr, two_markers()).write(layouts->front().fields));
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_NEAR(std::get<RangeBearing>(seen[0].value).bearing_rad, std::atan2(-1.0, 2.0) - std::atan(1.0) * 2.0,
              1e-6);
}

std::string aruco_markers(std::initializer_list<std::pair<std::int64_t, double>> markers) {
  Wire wire(Encoding::kCdr);
  wire.add<std::int32_t>(1).add<std::uint32_t>(0).text("camera");
  wire.add(static_cast<std::uint32_t>(markers.size()));
  for (const auto& [id, x] : markers) wire.add(id);
  wire.add(static_cast<std::uint32_t>(markers.size()));
  for (const auto& [id, x] : markers)
    for (const double value : {x, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0}) wire.add(value);
  return wire.bytes();
}

TEST(DetectionMessages, LeaveOutAndCountWhatCannotBeUsed) {
  auto reader = detection_reader(topic_of("ros2_aruco_interfaces/ArucoMarkers", Encoding::kCdr), {});
  ASSERT_TRUE(reader.ok());
  const auto seen =
      observations_of(*reader, aruco_markers({{-1, 0.0}, {5, 0.0}, {std::int64_t{1} << 40U, 0.0}, {6, NAN}}));
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].id->number, 5);
  observations_of(*reader, aruco_markers({{-1, 0.0}}));
  EXPECT_THAT(reader->notes(),
              ElementsAre(AllOf(HasSubstr("/seen: 3 observations without a usable identity left out"),
                                HasSubstr("the first with -1")),
                          HasSubstr("/seen: 1 observations whose position is not finite left out")));
}

MarkerOutlines outlines_of(const Topic& topic, const std::string& bytes) {
  auto reader = outline_reader(topic);
  EXPECT_TRUE(reader.ok()) << reader.error().message;
  const auto done = reader->decoder.decode(bytes);
  EXPECT_TRUE(done.ok()) << done.error().message;
  return std::get<MarkerOutlines>(*reader->content(reader->decoder));
}

TEST(DetectionMessages, TagsHaveTheSameBytesInTheirOlderDefinition) {
  Wire wire(Encoding::kCdr);
  wire.add<std::int32_t>(1).add<std::uint32_t>(0).text("camera").add<std::uint32_t>(1);
  wire.text("tag36h11").add<std::int32_t>(17).add<std::int32_t>(0).add(0.0F).add(50.0F).add(20.0).add(30.0);
  for (const double value : {10.5, 40.5, 30.5, 41.5, 31.5, 20.5, 11.5, 19.5}) wire.add(value);
  for (int i = 0; i < 9; ++i) wire.add(0.0);
  for (const char* definition :
       {"",
        "std_msgs/Header header\nAprilTagDetection[] detections\n========\n"
        "MSG: apriltag_msgs/AprilTagDetection\nstring family\nint32 id\nint32 hamming\nfloat32 goodness\n"
        "float32 decision_margin\nfloat64[2] centre\nfloat64[8] corners\nfloat64[9] homography\n"}) {
    const Topic tags = topic_of("apriltag_msgs/AprilTagDetectionArray", Encoding::kCdr, definition);
    const auto outlines = outlines_of(tags, wire.bytes());
    ASSERT_EQ(outlines.size(), 1U) << definition;
    EXPECT_EQ(outlines[0].id, 17);
    EXPECT_EQ(outlines[0].corners_px[0], Eigen::Vector2d(11.0, 19.0));
    EXPECT_EQ(outlines[0].corners_px[2], Eigen::Vector2d(30.0, 41.0));
    EXPECT_TRUE(outlines_are_rectified(tags.type));
  }
}

TEST(DetectionMessages, FiducialsHaveTheirCornersInOrder) {
  const Topic fiducials = topic_of("fiducial_msgs/FiducialArray", Encoding::kRos1);
  EXPECT_TRUE(is_outline(fiducials));
  EXPECT_LT(detection_rank(fiducials), 0);
  EXPECT_FALSE(outlines_are_rectified(fiducials.type)) << "aruco_detect looks at images as they come";
  Wire wire(Encoding::kRos1);
  wire.add<std::uint32_t>(3).add<std::uint32_t>(1).add<std::uint32_t>(0).text("camera");
  wire.add<std::int32_t>(9).add<std::uint32_t>(2);
  for (const int id : {17, -1}) {
    wire.add(id).add<std::int32_t>(0);
    for (const double value : {11.0, 19.0, 31.0, 20.0, 30.0, 41.0, 10.0, 40.0}) wire.add(value);
  }
  auto reader = outline_reader(fiducials);
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  ASSERT_TRUE(reader->decoder.decode(wire.bytes()).ok());
  const auto outlines = std::get<MarkerOutlines>(*reader->content(reader->decoder));
  ASSERT_EQ(outlines.size(), 1U);
  EXPECT_EQ(outlines[0].id, 17);
  EXPECT_THAT(outlines[0].corners_px, ElementsAre(Eigen::Vector2d(11.0, 19.0), Eigen::Vector2d(31.0, 20.0),
                                                  Eigen::Vector2d(30.0, 41.0), Eigen::Vector2d(10.0, 40.0)));
  EXPECT_THAT(reader->notes(),
              ElementsAre(HasSubstr("/seen: 1 observations without a usable identity left out")));
}

}  // namespace
}  // namespace waymark::bag
