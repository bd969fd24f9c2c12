#include "workbench/bags/message_definition.hpp"

#include <gmock/gmock.h>

namespace waymark::bag {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Topic stored_as(std::string type, Encoding encoding, std::string definition) {
  return {.name = "/t", .type = std::move(type), .encoding = encoding, .definition = std::move(definition)};
}

std::vector<std::string> names_of(const std::vector<Field>& fields) {
  std::vector<std::string> names;
  for (const Field& field : fields) names.push_back(field.name);
  return names;
}

TEST(MessageDefinition, OfTypesInUseIsKnown) {
  for (const char* type :
       {"nav_msgs/Odometry", "sensor_msgs/JointState", "sensor_msgs/Image", "sensor_msgs/CameraInfo",
        "sensor_msgs/CompressedImage", "geometry_msgs/PoseStamped", "geometry_msgs/TwistStamped",
        "geometry_msgs/Twist", "tf2_msgs/TFMessage", "apriltag_msgs/AprilTagDetectionArray",
        "fiducial_msgs/FiducialArray"})
    for (const Encoding encoding : {Encoding::kRos1, Encoding::kCdr}) {
      const auto layouts = layouts_of(stored_as(type, encoding, ""));
      ASSERT_TRUE(layouts.ok()) << layouts.error().message;
      EXPECT_FALSE(layouts->front().fields.empty()) << type;
      EXPECT_FALSE(layouts->front().is_stored) << type;
    }
  EXPECT_THAT(known_definitions("std_msgs/String", Encoding::kCdr), IsEmpty());
}

TEST(MessageDefinition, OfHeadersDiffersInRos1) {
  const auto header_of = [](Encoding encoding) {
    const auto layouts = layouts_of(stored_as("geometry_msgs/PoseStamped", encoding, ""));
    return names_of(layouts->front().fields.front().fields);
  };
  EXPECT_THAT(header_of(Encoding::kRos1), ElementsAre("seq", "stamp", "frame_id"));
  EXPECT_THAT(header_of(Encoding::kCdr), ElementsAre("stamp", "frame_id"));
}

TEST(MessageDefinition, InTheBagComesFirstAndTheKnownOneNext) {
  const auto layouts = layouts_of(stored_as("geometry_msgs/Twist", Encoding::kCdr, "float64 speed\n"));
  ASSERT_TRUE(layouts.ok());
  ASSERT_EQ(layouts->size(), 2U);
  EXPECT_TRUE((*layouts)[0].is_stored);
  EXPECT_THAT(names_of((*layouts)[0].fields), ElementsAre("speed"));
  EXPECT_THAT(names_of((*layouts)[1].fields), ElementsAre("linear", "angular"));
}

TEST(MessageDefinition, ThatCannotBeReadLeavesTheKnownOne) {
  for (const char* stored :
       {"module geometry_msgs { module msg { struct Twist { geometry_msgs::msg::Vector3 linear; }; }; };",
        R"(// generated from rosidl
#include "geometry_msgs/msg/Vector3.idl")",
        R"({"type": "object"})", "Vector3 linear\nVector3", "my_msgs/Vector linear\nVector3 angular\n"}) {
    const auto layouts = layouts_of(stored_as("geometry_msgs/Twist", Encoding::kCdr, stored));
    ASSERT_TRUE(layouts.ok()) << layouts.error().message;
    ASSERT_EQ(layouts->size(), 1U) << stored;
    EXPECT_FALSE(layouts->front().is_stored) << stored;
  }
}

TEST(MessageDefinition, OfAnUnknownTypeIsAnError) {
  EXPECT_THAT(layouts_of(stored_as("my_msgs/Mine", Encoding::kCdr, "")).error().message,
              HasSubstr("/t: the definition of my_msgs/Mine does not include that of my_msgs/Mine"));
  EXPECT_THAT(layouts_of(stored_as("my_msgs/Mine", Encoding::kCdr, "Other o\n")).error().message,
              HasSubstr("my_msgs/Other"));
}

TEST(MessageDefinition, WithOtherNamesCanHaveTheSameWire) {
  const auto fields = [](const char* definition) {
    return *parse_definition(stored_as("my_msgs/Mine", Encoding::kCdr, definition));
  };
  EXPECT_TRUE(have_same_wire(fields("float64[9] K\nstring a\n"), fields("float64[9] k\nstring b\n")));
  EXPECT_FALSE(have_same_wire(fields("float64[9] k\n"), fields("float64[8] k\n")));
  EXPECT_FALSE(have_same_wire(fields("float64[9] k\n"), fields("float64[] k\n")));
  EXPECT_FALSE(have_same_wire(fields("float64 k\n"), fields("float64 k\nuint8 l\n")));
  EXPECT_FALSE(have_same_wire(fields("geometry_msgs/Point p\n"), fields("geometry_msgs/Quaternion p\n")));
}

}  // namespace
}  // namespace waymark::bag
