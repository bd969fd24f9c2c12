#include "workbench/live/pose_publisher.hpp"

#include <poll.h>
#include <unistd.h>

#include <array>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace waymark::live {
namespace {

StampedPose pose() {
  Eigen::Matrix3d P;
  P << 1.0, 0.5, 0.25, 0.5, 2.0, 0.125, 0.25, 0.125, 3.0;
  return {stamp_from_seconds(1.5), {{1.0, -2.0, 0.5}, P}};
}

TEST(PosePublisher, WritesThePoseAsJson) {
  const auto json = nlohmann::json::parse(to_json_line(pose()));
  EXPECT_EQ(json["stamp_s"], 1.5);
  EXPECT_EQ(json["x_m"], 1.0);
  EXPECT_EQ(json["y_m"], -2.0);
  EXPECT_EQ(json["theta_rad"], 0.5);
  EXPECT_EQ(json["covariance"], nlohmann::json({1.0, 0.5, 0.25, 2.0, 0.125, 3.0}));
}

TEST(PosePublisher, SendsDatagrams) {
  const auto receiver = open_for_reading(parse_address("udp://127.0.0.1:47011", 115200).value());
  ASSERT_TRUE(receiver.ok()) << receiver.error().message;
  auto publisher = PosePublisher::open("udp://127.0.0.1:47011");
  ASSERT_TRUE(publisher.ok());
  publisher->send(pose());
  pollfd ready{receiver->get(), POLLIN, 0};
  ASSERT_EQ(poll(&ready, 1, 2000), 1);
  std::array<char, 512> buffer{};
  const auto count = read(receiver->get(), buffer.data(), buffer.size());
  EXPECT_EQ(std::string(buffer.data(), static_cast<std::size_t>(count)), to_json_line(pose()) + "\n");
}

TEST(PosePublisher, NeedsAnAddressOfDatagrams) {
  EXPECT_FALSE(PosePublisher::open("tcp://127.0.0.1:9").ok());
  EXPECT_FALSE(PosePublisher::open("udp://127.0.0.1").ok());
}

}  // namespace
}  // namespace waymark::live
