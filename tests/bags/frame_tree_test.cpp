#include "workbench/bags/frame_tree.hpp"

#include <gtest/gtest.h>

#include "bags/wire.hpp"

namespace waymark::bag {
namespace {

constexpr const char* kTransformDefinition = R"(geometry_msgs/TransformStamped[] transforms
================================================================================
MSG: geometry_msgs/TransformStamped
std_msgs/Header header
string child_frame_id
geometry_msgs/Transform transform
================================================================================
MSG: std_msgs/Header
uint32 seq
time stamp
string frame_id
================================================================================
MSG: geometry_msgs/Transform
geometry_msgs/Vector3 translation
geometry_msgs/Quaternion rotation
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
)";

/// One transform without rotation.
std::string message(const char* parent, const char* child, double x_m) {
  test::Wire wire(Encoding::kRos1);
  wire.add<std::uint32_t>(1).add<std::uint32_t>(0).add<std::uint64_t>(0).text(parent).text(child);
  for (const double value : {x_m, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}) wire.add(value);
  return wire.bytes();
}

class FrameTreeTest : public testing::Test {
 protected:
  void tell(const char* topic, const char* parent, const char* child, double x_m) {
    frames_.add({topic, "tf2_msgs/TFMessage", Encoding::kRos1, kTransformDefinition, 1},
                message(parent, child, x_m));
  }
  FrameTree frames_;
};

TEST_F(FrameTreeTest, FollowsWhatIsFixed) {
  tell("/tf_static", "base_link", "mast", 0.5);
  tell("/robot/tf_static", "/mast", "/camera", 0.25);
  ASSERT_TRUE(frames_.find("base_link", "camera"));
  EXPECT_EQ(frames_.find("base_link", "camera")->translation().x(), 0.75);
  EXPECT_FALSE(frames_.find("camera", "base_link"));
  EXPECT_EQ(frames_.leaves(), std::vector<std::string>{"camera"});
}

TEST_F(FrameTreeTest, TakesATransformOnTfThatNeverChangesForFixed) {
  tell("/tf", "base_link", "camera", 0.5);
  EXPECT_FALSE(frames_.find("base_link", "camera"));  // once says nothing
  for (int i = 0; i < 5; ++i) tell("/tf", "base_link", "camera", 0.5);
  EXPECT_TRUE(frames_.find("base_link", "camera"));
  for (int i = 0; i < 5; ++i) tell("/tf", "odom", "base_link", 0.1 * i);
  EXPECT_FALSE(frames_.find("odom", "camera"));
  EXPECT_TRUE(frames_.moves_in("base_link", "odom"));
  EXPECT_FALSE(frames_.moves_in("camera", "base_link"));
  tell("/tf", "base_link", "camera", 0.6);
  EXPECT_FALSE(frames_.find("base_link", "camera"));
}

TEST_F(FrameTreeTest, BelievesTfStaticBeforeTf) {
  tell("/tf_static", "base_link", "camera", 0.5);
  tell("/tf", "base_link", "camera", 0.7);
  ASSERT_TRUE(frames_.find("base_link", "camera"));
  EXPECT_EQ(frames_.find("base_link", "camera")->translation().x(), 0.5);
}

TEST_F(FrameTreeTest, FindsNamesWithoutTheirPrefix) {
  tell("/tf_static", "robot1/base_link", "robot1/camera", 0.5);
  EXPECT_EQ(frames_.resolve("base_link"), "robot1/base_link");
  EXPECT_EQ(frames_.resolve("robot1/camera"), "robot1/camera");
  EXPECT_EQ(frames_.resolve("other/camera"), "robot1/camera");
  EXPECT_EQ(frames_.resolve("lidar"), "lidar");
  tell("/tf_static", "robot2/base_link", "robot2/camera", 0.6);
  EXPECT_EQ(frames_.resolve("base_link"), "base_link");
}

TEST_F(FrameTreeTest, OutlivesFramesThatHangOnEachOther) {
  tell("/tf_static", "a", "b", 1.0);
  tell("/tf_static", "b", "a", 1.0);
  EXPECT_FALSE(frames_.find("c", "a"));
  EXPECT_FALSE(frames_.moves_in("a", "c"));
}

}  // namespace
}  // namespace waymark::bag
