#include "workbench/run/acting_keys.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using testing::HasSubstr;
using testing::Not;

LogInfo log_of(const std::string& format) {
  LogInfo log;
  log.format = format;
  return log;
}

TEST(ActingKeys, OfAnEkfOverAFolderAreNotThoseOfOthers) {
  const std::string yaml = acting_yaml({}, log_of("log folder"), OdometryKind::kWheels);
  for (const char* part : {"\nsim:", "\nfastslam:", "\npixel:", "\ncamera:", "\ncorners:", "\nmarkers:",
                           "\ninput:", "\ncar:", "\nassociation:", "localize", "keyframe_distance"})
    EXPECT_THAT(yaml, Not(HasSubstr(part)));
  for (const char* part : {"filter:", "\nekf:", "\nwheels:", "\nsensor:", "\nsmooth:\n", "  run: false"})
    EXPECT_THAT(yaml, HasSubstr(part));
}

TEST(ActingKeys, FollowWhatIsRun) {
  Config config;
  const auto acts = [&config](std::string_view key, const LogInfo& log = log_of("MRCLAM"),
                              OdometryKind odometry = OdometryKind::kVelocity) {
    return can_act(key, config, log, odometry);
  };
  EXPECT_TRUE(acts("input.robot"));
  EXPECT_FALSE(acts("input.stamps"));
  EXPECT_TRUE(acts("sim.laps", log_of("simulation")));
  EXPECT_TRUE(acts("motion.outer_point_m"));
  EXPECT_FALSE(acts("motion.outer_point_m", {}, OdometryKind::kSteering));
  EXPECT_TRUE(acts("car.wheel_base_m", {}, OdometryKind::kSteering));
  EXPECT_FALSE(acts("motion.speed_scale_sigma"));
  config.smooth.run = true;
  EXPECT_TRUE(acts("motion.speed_scale_sigma"));
  EXPECT_TRUE(acts("smooth.robust_dof"));
  config.filter = FilterKind::kFastSlam;
  EXPECT_TRUE(acts("fastslam.particles"));
  EXPECT_FALSE(acts("ekf.likelihood"));
  config.filter = FilterKind::kEkf;
  config.observe = Observe::kPixel;
  EXPECT_TRUE(acts("camera.fu_px"));
  EXPECT_TRUE(acts("ekf.consistency"));
  EXPECT_FALSE(acts("ekf.likelihood"));
  EXPECT_FALSE(acts("sensor.range_sigma_m"));
  EXPECT_TRUE(acts("sensor.delay_s"));
  LogInfo bag = log_of("ROS 2 bag");
  bag.topics.emplace_back();
  EXPECT_TRUE(acts("input.stamps", bag));
  EXPECT_FALSE(acts("input.robot", bag));
  config.observe = Observe::kRangeBearing;
  EXPECT_TRUE(acts("camera.mount_yaw_deg", bag));
  EXPECT_FALSE(acts("camera.mount_yaw_deg"));
  EXPECT_FALSE(acts("camera.fu_px", bag));
}

TEST(ActingKeys, AreAllTheSettingsOfALogThatCount) {
  LogInfo bag = log_of("ROS 2 bag");
  bag.topics.emplace_back();
  for (const Observe observe : {Observe::kPixel, Observe::kRangeBearing, Observe::kMarkers}) {
    Config config;
    config.observe = observe;
    config.sensor.delay_s = 0.25;
    config.camera.mount.z_m = 1.5;
    config.odometry.noise.turn_var_rad2_per_m = 0.125;
    const std::string yaml = acting_yaml(config, bag, std::nullopt);
    Config again;
    Schema schema = describe(again);
    ASSERT_TRUE(schema.load_text(yaml, "again").ok());
    EXPECT_EQ(acting_yaml(again, bag, std::nullopt), yaml);
    EXPECT_EQ(again.observe, observe);
    EXPECT_EQ(again.sensor.delay_s, 0.25) << "shifts images and pixels, too";
    EXPECT_EQ(again.camera.mount.z_m, 1.5) << "detections in a bag are seen from there";
    EXPECT_EQ(again.odometry.noise.turn_var_rad2_per_m, 0.125);
  }
}

}  // namespace
}  // namespace waymark
