#include "workbench/config/filter_keys.hpp"

#include <string>

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(FilterKeys, OfAssociationHaveDefaultsWithinTheirLimits) {
  AssociationOptions options;
  Schema schema;
  describe(schema, options);
  for (const std::string& key : schema.keys()) EXPECT_TRUE(schema.set(key, schema.value(key), "test")) << key;
  EXPECT_FALSE(schema.set("association.false_alarm_probability", "1", "test"));
}

TEST(FilterKeys, SetFastSlam) {
  FastSlamOptions options;
  Schema schema;
  describe(schema, options);
  EXPECT_TRUE(schema.set("fastslam.particles", "400", "--set").ok());
  EXPECT_EQ(options.particles, 400);
  EXPECT_FALSE(schema.set("fastslam.particles", "0", "--set").ok());
  EXPECT_EQ(schema.value("fastslam.always_resample"), "false");
  EXPECT_TRUE(schema.set("fastslam.always_resample", "true", "--set").ok());
  EXPECT_EQ(options.resample_below, 1.0);
  EXPECT_EQ(options.temper_below, 0.0);
  EXPECT_EQ(schema.value("fastslam.always_resample"), "true");
  EXPECT_TRUE(schema.set("fastslam.always_resample", "false", "--set").ok());
  EXPECT_EQ(options.resample_below, FastSlamOptions{}.resample_below);
  EXPECT_EQ(options.temper_below, FastSlamOptions{}.temper_below);
}

TEST(FilterKeys, SetSmoothing) {
  SmoothOptions options;
  Schema schema;
  describe(schema, options);
  ASSERT_TRUE(schema.load_text(schema.to_yaml(), "defaults").ok()) << "a default is beyond its own limits";
  EXPECT_FALSE(options.run);
  EXPECT_TRUE(schema.set("smooth.run", "true", "test").ok());
  EXPECT_TRUE(schema.set("smooth.odometry_is_commanded", "true", "test").ok());
  EXPECT_TRUE(options.run);
  EXPECT_TRUE(options.odometry_is_commanded);
  EXPECT_FALSE(schema.set("smooth.robust_dof", "0", "test").ok());
}

}  // namespace
}  // namespace waymark
