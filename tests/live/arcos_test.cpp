#include "workbench/live/arcos.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/stamps.hpp"

namespace waymark::live {
namespace {

using test::at;

std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int value : values) text += static_cast<char>(value);
  return text;
}

/// As the library of the robot's maker writes them.
TEST(Arcos, PacketsAreThoseOfTheMaker) {
  EXPECT_EQ(arcos_packet(bytes({0})), bytes({0xfa, 0xfb, 3, 0, 0, 0}));
  EXPECT_EQ(arcos_command(ArcosCommand::kOpen), bytes({0xfa, 0xfb, 3, 1, 0, 1}));
  EXPECT_EQ(arcos_packet(bytes({0x13, 0x3b, 2, 0})), bytes({0xfa, 0xfb, 6, 0x13, 0x3b, 2, 0, 0x15, 0x3b}));
}

std::string information(int x, int y, int heading) {
  return bytes({0x33, x & 255, x >> 8, y & 255, y >> 8, heading & 255, (heading >> 8) & 255, 0, 0});
}

TEST(ArcosSplitter, FindsPacketsInPiecesAndNoise) {
  const std::string good = arcos_packet(information(1, 2, 3));
  std::string bad = good;
  bad[5] ^= 0x10;
  const std::string all = bytes({0, 0xfa, 7}) + good + bad + bytes({0xfa}) + good;
  ArcosSplitter packets;
  int found = 0;
  for (const char each : all) {
    packets.add(std::string(1, each));
    while (const auto data = packets.next()) {
      EXPECT_EQ(*data, information(1, 2, 3));
      ++found;
    }
  }
  EXPECT_EQ(found, 2);
  EXPECT_EQ(packets.damaged(), 1);
}

TEST(ArcosOdometry, FollowsCountersThatWrap) {
  for (const int wrap : {4096, 0x8000, 0x10000}) {
    ArcosOdometry odometry(0.485);
    double x_m = 0.0;
    for (int i = 0; i < 3000; ++i) {
      const auto pose = odometry.add(information((100 * i) % wrap, (wrap - i) % wrap, 1024));
      ASSERT_TRUE(pose);
      x_m = 100 * i * 0.485e-3;
      ASSERT_NEAR(pose->T_odom_robot.x_m, x_m, 1e-9) << wrap;
      ASSERT_NEAR(pose->T_odom_robot.y_m, -i * 0.485e-3, 1e-9) << wrap;
      ASSERT_NEAR(pose->T_odom_robot.theta_rad, std::numbers::pi / 2.0, 1e-9);
    }
  }
}

TEST(ArcosOdometry, PassesOverOtherPackets) {
  ArcosOdometry odometry(1.0);
  EXPECT_FALSE(odometry.add(bytes({0x90, 1, 2, 3, 4, 5, 6, 7, 8})));
  EXPECT_FALSE(odometry.add(bytes({0x33, 1})));
}

TEST(ArcosHandshake, SaysOneThingAfterTheOther) {
  ArcosHandshake handshake;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(handshake.next(at(0.1 * i)), arcos_packet(bytes({i})));
    EXPECT_EQ(handshake.next(at(0.1 * i + 0.05)), "");
    handshake.heard(i == 2 ? bytes({2}) + "Robot" : bytes({i}));
  }
  EXPECT_EQ(handshake.next(at(0.3)), arcos_command(ArcosCommand::kOpen));
  EXPECT_TRUE(handshake.is_open());
  EXPECT_EQ(handshake.next(at(0.5)), "");
  EXPECT_EQ(handshake.next(at(1.35)), arcos_command(ArcosCommand::kPulse));
  EXPECT_EQ(handshake.next(at(1.4)), "");
}

TEST(ArcosHandshake, BeginsAnewWhereNobodyAnswers) {
  ArcosHandshake handshake;
  EXPECT_EQ(handshake.next(at(0.0)), arcos_packet(bytes({0})));
  handshake.heard(bytes({0}));
  EXPECT_EQ(handshake.next(at(0.1)), arcos_packet(bytes({1})));
  EXPECT_EQ(handshake.next(at(0.3)), "");
  EXPECT_EQ(handshake.next(at(0.7)), arcos_packet(bytes({0})));
}

}  // namespace
}  // namespace waymark::live
