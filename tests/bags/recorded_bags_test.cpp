// The readers on bags that ROS itself recorded; the expected values are those that Debian's python3-rosbag
// and the sqlite3 program print.
#include <array>
#include <cmath>

#include <gmock/gmock.h>

#include "support/data_dir.hpp"
#include "support/io_support.hpp"

#include "workbench/bags/open_bag.hpp"
#include "workbench/logs/image_loader.hpp"
#include "workbench/run/open_source.hpp"

namespace waymark {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

std::unique_ptr<Source> open_recorded(const char* name, const InputOptions& options = {}) {
  auto source = open_source(test::data_path(name), options);
  EXPECT_TRUE(source.ok()) << source.error().message;
  return source ? *std::move(source) : nullptr;
}

double length_m(const std::vector<std::pair<Stamp, OdometryPose>>& path) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
    sum_m += (path[i].second.T_odom_robot.position() - path[i - 1].second.T_odom_robot.position()).norm();
  return sum_m;
}

TEST(RecordedBags, HuskyInBz2) {
  WAYMARK_REQUIRE_DATA("odom-bags/husky_test1.bag");
  const auto source = open_recorded("odom-bags/husky_test1.bag");
  ASSERT_NE(source, nullptr);
  const auto delivered = test::read_all(*source);
  EXPECT_EQ(delivered.error, "");
  const auto path = test::only<OdometryPose>(delivered.events);
  ASSERT_EQ(path.size(), 3952U);
  EXPECT_EQ(test::only<YawRate>(delivered.events).size(), 11865U);
  EXPECT_TRUE(std::ranges::is_sorted(path, {}, &std::pair<Stamp, OdometryPose>::first));
  EXPECT_EQ(to_string(path[0].first), "1432235498.027976030");
  const Pose2& first = path[0].second.T_odom_robot;
  EXPECT_EQ(first.x_m, 8.251562792367952);
  EXPECT_EQ(first.y_m, -0.30489320435155026);
  EXPECT_NEAR(first.theta_rad, 2.0 * std::atan2(-0.1359940102210928, 0.9907096593775521), 1e-12);
  EXPECT_NEAR(length_m(path), 358.8, 0.05);
  EXPECT_EQ(source->info().format, "ROS 1 bag");
  ASSERT_EQ(source->info().topics.size(), 3U);
  EXPECT_EQ(source->info().topics[0].messages, 11865);
  EXPECT_EQ(source->info().topics[0].use, "the gyro");
  EXPECT_EQ(source->info().topics[1].use, "odometry");
  EXPECT_EQ(source->info().topics[2].messages, 989);
  EXPECT_NEAR(source->info().recorded_s, 395.3, 0.1);
  EXPECT_THAT(source->notes(), Contains(HasSubstr("not used: /fix (sensor_msgs/NavSatFix)")));
}

TEST(RecordedBags, JackalInBz2) {
  WAYMARK_REQUIRE_DATA("odom-bags/jackal_test2.bag");
  const auto source = open_recorded("odom-bags/jackal_test2.bag");
  ASSERT_NE(source, nullptr);
  const auto path = test::only<OdometryPose>(test::read_all(*source).events);
  ASSERT_EQ(path.size(), 3060U);
  EXPECT_EQ(to_string(path[0].first), "47.584000000");
  EXPECT_EQ(path[0].second.T_odom_robot.x_m, 0.1571574254425733);
  EXPECT_NEAR(length_m(path), 84.2, 0.05);
}

std::unique_ptr<Source> open_images(const char* bag, const char* topic) {
  InputOptions options;
  options.bag.image_topic = topic;
  return open_recorded(bag, options);
}

constexpr std::array kTinyBags{"odom-bags/tiny_camera_imu_ros1.bag", "odom-bags/tiny_camera_imu_ros2.db3"};

TEST(RecordedBags, RawImagesOfRos1AndRos2) {
  for (const char* bag : kTinyBags) {
    WAYMARK_REQUIRE_DATA(bag);
    const auto source = open_images(bag, "");
    ASSERT_NE(source, nullptr);
    EXPECT_THAT(
        source->notes(),
        Contains(HasSubstr("the camera is not calibrated (no sensor_msgs/CameraInfo): `waymark calibrate")));
    const auto images = test::only<Image>(test::read_all(*source).events);
    ASSERT_EQ(images.size(), 3U);
    EXPECT_EQ(to_string(images[1].first), "1700000000.100000000");
    // Red grows by 40 from image to image over green 100 and blue 50.
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(
          *images[static_cast<std::size_t>(i)].second.pixels,
          GreyImage(8, 6, static_cast<std::uint8_t>((299 * 40 * i + 587 * 100 + 114 * 50 + 500) / 1000)));
  }
}

TEST(RecordedBags, JpegImagesOfRos1AndRos2StayPackedUntilTheyAreLoaded) {
  for (const char* bag : kTinyBags) {
    WAYMARK_REQUIRE_DATA(bag);
    const auto packed = open_images(bag, "camera/compressed");
    ASSERT_NE(packed, nullptr);
    std::vector<std::size_t> sizes;
    for (const auto& [stamp, image] : test::only<Image>(test::read_all(*packed).events)) {
      EXPECT_EQ(image.pixels, nullptr);
      sizes.push_back(image.encoded->size());
    }
    EXPECT_THAT(sizes, ElementsAre(634U, 634U, 633U));
    ImageLoader loader(open_images(bag, "camera/compressed"));
    for (const auto& [stamp, image] : test::only<Image>(test::read_all(loader).events))
      EXPECT_EQ(image.pixels->width_px(), 8);
  }
}

TEST(RecordedBags, CameraAndImageOfTheCeiling) {
  WAYMARK_REQUIRE_DATA("marker-photos/aruco_images.bag");
  auto source = open_recorded("marker-photos/aruco_images.bag");
  ASSERT_NE(source, nullptr);
  EXPECT_THAT(source->info().settings, Contains(Pair("camera.fu_px", "1014.343103379204")));
  EXPECT_THAT(source->info().settings, Contains(Pair("camera.p2", "0.001586362091473342")));
  EXPECT_TRUE(source->info().only_pixels);
  ImageLoader loader(std::move(source));
  const auto images = test::only<Image>(test::read_all(loader).events);
  ASSERT_EQ(images.size(), 1U);
  EXPECT_EQ(to_string(images[0].first), "1491682360.314066469");
  EXPECT_EQ(images[0].second.pixels->width_px(), 1280);
}

TEST(RecordedBags, MarkersThatADetectorFound) {
  WAYMARK_REQUIRE_DATA("marker-photos/aruco_transforms.bag");
  const auto source = open_recorded("marker-photos/aruco_transforms.bag");
  ASSERT_NE(source, nullptr);
  const auto scans = test::only<Observations>(test::read_all(*source).events);
  ASSERT_EQ(scans.size(), 1U);
  std::vector<int> ids;
  for (const auto& observation : scans[0].second) ids.push_back(observation.id->number);
  EXPECT_THAT(ids, testing::UnorderedElementsAre(100, 103, 106, 107, 110, 111, 112));
  // Of marker 103, seen at (-1.673, 0.392, 2.896) by a camera that is taken to look ahead.
  ASSERT_EQ(ids[0], 103);
  const auto& [range_m, bearing_rad] = std::get<RangeBearing>(scans[0].second[0].value);
  EXPECT_NEAR(range_m, std::hypot(1.673025127085304, 2.89584207865679), 1e-12);
  EXPECT_NEAR(bearing_rad, std::atan2(1.673025127085304, 2.89584207865679), 1e-12);
  EXPECT_THAT(source->notes(), Contains(HasSubstr("no transform has the position of the camera raspicam")));
}

TEST(RecordedBags, ACameraThatLooksUpSeesTheCeilingWhereItIs) {
  WAYMARK_REQUIRE_DATA("marker-photos/aruco_transforms.bag");
  InputOptions options;
  options.bag.mount = CameraMount{.pitch_deg = -90.0};
  const auto source = open_recorded("marker-photos/aruco_transforms.bag", options);
  ASSERT_NE(source, nullptr);
  const auto scans = test::only<Observations>(test::read_all(*source).events);
  const auto& [range_m, bearing_rad] = std::get<RangeBearing>(scans.at(0).second[0].value);
  // Down in the image is ahead of the robot.
  EXPECT_NEAR(range_m, std::hypot(1.673025127085304, 0.39191576078598234), 1e-9);
  EXPECT_NEAR(bearing_rad, std::atan2(1.673025127085304, 0.39191576078598234), 1e-9);
}

TEST(RecordedBags, ATopicThatIsNotThereIsRefusedWithThoseThatAre) {
  WAYMARK_REQUIRE_DATA("odom-bags/husky_test1.bag");
  InputOptions options;
  options.bag.odometry_topic = "/odom";
  EXPECT_THAT(open_source(test::data_path("odom-bags/husky_test1.bag"), options).error().message,
              HasSubstr("input.odometry_topic: the bag has no topic /odom with odometry; possible are "
                        "/husky_velocity_controller/odom"));
  options.bag.odometry_topic = "none";
  const auto source = open_recorded("odom-bags/husky_test1.bag", options);
  ASSERT_NE(source, nullptr);
  EXPECT_THAT(test::read_all(*source).events, IsEmpty());
}

TEST(RecordedBags, WhatIsNotWantedIsNotRead) {
  WAYMARK_REQUIRE_DATA("odom-bags/husky_test1.bag");
  auto bag = bag::open_bag(test::data_path("odom-bags/husky_test1.bag"));
  ASSERT_TRUE(bag.ok()) << bag.error().message;
  (*bag)->rewind({false, false, true});
  int fixes = 0;
  while (const auto message = (*bag)->next()) {
    EXPECT_EQ(message->topic, 2U);
    ++fixes;
  }
  EXPECT_EQ(fixes, 989);
  EXPECT_THAT((*bag)->notes(), IsEmpty());
}

}  // namespace
}  // namespace waymark
