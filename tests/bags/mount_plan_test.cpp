#include "workbench/bags/mount_plan.hpp"

#include <gmock/gmock.h>

#include "waymark/models/camera.hpp"

#include "bags/wire.hpp"

namespace waymark::bag {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// As older ROS 2 has it, by heart.
Topic transforms(const char* name) { return {name, "tf2_msgs/TFMessage", Encoding::kCdr, "", 1}; }

class MountPlanTest : public testing::Test {
 protected:
  void tell(const char* topic, const char* parent, const char* child, const Eigen::Isometry3d& T) {
    test::Wire wire(Encoding::kCdr);
    wire.add<std::uint32_t>(1).add<std::int32_t>(0).add<std::uint32_t>(0).text(parent).text(child);
    const Eigen::Quaterniond q(T.linear());
    for (const double value :
         {T.translation().x(), T.translation().y(), T.translation().z(), q.x(), q.y(), q.z(), q.w()})
      wire.add(value);
    frames_.add(transforms(topic), wire.bytes());
  }
  void fix(const char* parent, const char* child, double x_m, double z_m = 0.0) {
    tell("/tf_static", parent, child, Eigen::Isometry3d(Eigen::Translation3d(x_m, 0.0, z_m)));
  }

  FrameTree frames_;
  const RobotFrames robot_{"base_link", "odom"};
};

TEST_F(MountPlanTest, FollowsTransformsToTheRobot) {
  fix("base_link", "camera", 0.3, 0.2);
  const auto plan = plan_mount(frames_, robot_, "camera", "/tags");
  ASSERT_TRUE(plan.ok());
  ASSERT_TRUE(plan->T_robot_frame);
  EXPECT_EQ(plan->T_robot_frame->translation(), Eigen::Vector3d(0.3, 0.0, 0.2));
  EXPECT_THAT(plan->notes, IsEmpty());
}

TEST_F(MountPlanTest, CountsTheHeightFromTheGround) {
  fix("base_footprint", "base_link", 0.0, 0.1);
  fix("base_link", "camera", 0.3, 0.2);
  EXPECT_NEAR(plan_mount(frames_, robot_, "camera", "/tags")->T_robot_frame->translation().z(), 0.3, 1e-15);
}

TEST_F(MountPlanTest, TakesTheRobotsOwnFrameAsItIs) {
  const auto plan = plan_mount(frames_, robot_, "base_link", "/tags");
  ASSERT_TRUE(plan.ok() && plan->T_robot_frame);
  EXPECT_TRUE(plan->T_robot_frame->isApprox(Eigen::Isometry3d::Identity()));
}

TEST_F(MountPlanTest, FindsFramesThatHaveAPrefix) {
  fix("robot1/base_link", "robot1/camera", 0.3);
  EXPECT_TRUE(plan_mount(frames_, robot_, "camera", "/tags")->T_robot_frame);
  EXPECT_TRUE(plan_mount(frames_, {"robot1/base_link", "robot1/odom"}, "camera", "/tags")->T_robot_frame);
}

TEST_F(MountPlanTest, RefusesPlacesInAFrameInWhichTheRobotMoves) {
  for (const char* frame : {"odom", "map", "robot1/odom"}) {
    const auto plan = plan_mount(frames_, robot_, frame, "/tags");
    ASSERT_FALSE(plan.ok()) << frame;
    EXPECT_THAT(plan.error().message, HasSubstr(frame));
  }
  for (int i = 0; i < 3; ++i)
    tell("/tf", "start", "base_link", Eigen::Isometry3d(Eigen::Translation3d(0.1 * i, 0.0, 0.0)));
  EXPECT_FALSE(plan_mount(frames_, robot_, "start", "/tags").ok());
}

TEST_F(MountPlanTest, TakesTheOneCameraForMessagesWithoutAFrame) {
  EXPECT_THAT(plan_mount(frames_, robot_, "", "/tags")->notes, Contains(HasSubstr("without a frame")));
  fix("base_link", "camera_link", 0.3);
  fix("camera_link", "camera_optical_frame", 0.1);
  const auto plan = plan_mount(frames_, robot_, "", "/tags");
  ASSERT_TRUE(plan->T_robot_frame);
  EXPECT_EQ(plan->T_robot_frame->translation().x(), 0.4);
  EXPECT_THAT(plan->notes, Contains(HasSubstr("camera_optical_frame")));
  fix("base_link", "rear_optical_frame", -0.3);
  EXPECT_FALSE(plan_mount(frames_, robot_, "", "/tags")->T_robot_frame);
}

}  // namespace
}  // namespace waymark::bag
