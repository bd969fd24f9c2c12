#include "workbench/config/robot_keys.hpp"

#include <string>

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(RobotKeys, SetTheCamera) {
  CameraOptions o;
  Schema schema;
  describe(schema, o);
  ASSERT_TRUE(schema.set("camera.mount_pitch_deg", "12.5", "here").ok());
  ASSERT_TRUE(schema.set("camera.k1", "-0.25", "here").ok());
  EXPECT_EQ(o.mount.pitch_deg, 12.5);
  EXPECT_EQ(o.distortion.k1, -0.25);
  EXPECT_FALSE(schema.set("camera.fu_px", "0", "here").ok());
}

TEST(RobotKeys, SetTheSensor) {
  LandmarkSensor sensor;
  Schema schema;
  describe(schema, sensor);
  ASSERT_TRUE(schema.load_text(schema.to_yaml(), "defaults").ok()) << "a default is beyond its own limits";
  for (const auto& key : schema.keys()) EXPECT_TRUE(key.starts_with("sensor.")) << key;
  ASSERT_TRUE(schema.set("sensor.yaw_deg", "-90", "test").ok());
  EXPECT_EQ(sensor.yaw_deg, -90.0);
  EXPECT_FALSE(schema.set("sensor.range_sigma_m", "0", "test").ok()) << "S would not be positive definite";
  EXPECT_EQ(sensor.detection_probability, 0.0) << "what is not reported says nothing, unless it is told";
  ASSERT_TRUE(schema.set("sensor.detection_probability", "0.95", "test").ok());
  EXPECT_EQ(sensor.detection_probability, 0.95);
  EXPECT_FALSE(schema.set("sensor.detection_probability", "1", "test").ok()) << "one miss would rule all out";
}

TEST(RobotKeys, SetTheOdometry) {
  OdometryOptions options;
  Schema schema;
  describe(schema, options);
  ASSERT_TRUE(schema.load_text(schema.to_yaml(), "defaults").ok()) << "a default is beyond its own limits";
  ASSERT_TRUE(schema.set("wheels.track_m", "0.32", "test").ok());
  EXPECT_EQ(options.wheels.track_m, 0.32);
  EXPECT_FALSE(schema.set("motion.turn_var_rad2_per_m", "-1e-3", "test").ok());
}

}  // namespace
}  // namespace waymark
