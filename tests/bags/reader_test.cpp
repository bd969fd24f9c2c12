#include "workbench/bags/reader.hpp"

#include <gmock/gmock.h>

namespace waymark::bag {
namespace {

TEST(Reader, KnowsATypeByItsNameInEitherRosAndInIdl) {
  for (const char* name : {"nav_msgs/Odometry", "nav_msgs/msg/Odometry", "nav_msgs::msg::Odometry",
                           "nav_msgs::msg::dds_::Odometry_", "nav_msgs/msg/dds_/Odometry_"})
    EXPECT_EQ(plain_type(name), "nav_msgs/Odometry") << name;
  EXPECT_EQ(plain_type("my_msgs/Odometry_"), "my_msgs/Odometry_");
}

}  // namespace
}  // namespace waymark::bag
