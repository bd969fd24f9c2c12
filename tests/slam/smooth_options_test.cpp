#include "waymark/slam/smooth_options.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(SmoothOptions, DescribeTheirKeys) {
  SmoothOptions options;
  Schema schema;
  describe(schema, options);
  ASSERT_TRUE(schema.load_text(schema.to_yaml(), "defaults").ok()) << "a default is beyond its own limits";
  EXPECT_FALSE(options.run);
  EXPECT_TRUE(schema.set("smooth.run", "true", "test").ok());
  EXPECT_TRUE(schema.set("smooth.odometry_is_commanded", "true", "test").ok());
  EXPECT_TRUE(schema.set("smooth.turn_bias_sigma_degps", "0", "test").ok());
  EXPECT_TRUE(options.run);
  EXPECT_TRUE(options.odometry_is_commanded);
  EXPECT_EQ(options.turn_bias_sigma_degps, 0.0);
  EXPECT_FALSE(schema.set("smooth.robust_dof", "0", "test").ok());
}

}  // namespace
}  // namespace waymark
