#include "workbench/run/input_options.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(InputOptions, KeysAreBoundToTheOptions) {
  InputOptions options;
  Schema schema;
  describe(schema, options);
  EXPECT_TRUE(schema.set("input.robot", "3", "test").ok());
  EXPECT_TRUE(schema.set("input.fix_known_errors", "false", "test").ok());
  EXPECT_TRUE(schema.set("input.run", "2", "test").ok());
  EXPECT_TRUE(schema.set("input.pixel_noise_px", "0.5", "test").ok());
  EXPECT_EQ(options.robot, 3);
  EXPECT_EQ(options.run, 2);
  EXPECT_EQ(options.pixel_noise_px, 0.5);
  EXPECT_FALSE(options.fix_known_errors);
  EXPECT_FALSE(schema.set("input.robot", "0", "test").ok());
}

}  // namespace
}  // namespace waymark
