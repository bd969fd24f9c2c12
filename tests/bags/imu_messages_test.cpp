#include "workbench/bags/imu_messages.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "bags/wire.hpp"

namespace waymark::bag {
namespace {

using test::Wire;
using testing::HasSubstr;

/// A sensor_msgs/Imu with this angular velocity.
std::string imu_bytes(Encoding encoding, std::initializer_list<double> w_radps, double covariance = 1e-6,
                      const Eigen::Vector3d& a_mps2 = {0.0, 0.0, 9.81}) {
  Wire wire(encoding);
  if (encoding == Encoding::kRos1) wire.add<std::uint32_t>(0);  // seq
  wire.add<std::int32_t>(7).add<std::uint32_t>(0).text("imu_link");
  for (int i = 0; i < 4 + 9; ++i) wire.add(0.0);
  for (const double value : w_radps) wire.add(value);
  for (int i = 0; i < 9; ++i) wire.add(i == 0 ? covariance : 0.0);
  for (const double value : a_mps2) wire.add(value);
  for (int i = 0; i < 9; ++i) wire.add(0.0);
  return wire.bytes();
}

Topic imu_topic(const std::string& name, Encoding encoding = Encoding::kRos1) {
  return {.name = name, .type = std::string(kImu), .encoding = encoding, .definition = {}, .messages = 1};
}

Result<EventContent> read_imu(Encoding encoding, const std::string& bytes,
                              const Eigen::Vector3d& vertical = Eigen::Vector3d::UnitZ()) {
  auto reader = imu_reader(imu_topic("/imu", encoding), vertical);
  if (!reader) return reader.error();
  if (auto done = reader->decoder.decode(bytes); !done) return done.error();
  return reader->content(reader->decoder);
}

TEST(ImuMessages, TheRateAboutTheVerticalIsTheYawRateInRos1AndRos2) {
  for (const Encoding encoding : {Encoding::kRos1, Encoding::kCdr}) {
    const auto content = read_imu(encoding, imu_bytes(encoding, {0.1, 0.2, 0.3}));
    ASSERT_TRUE(content.ok()) << content.error().message;
    EXPECT_EQ(std::get<YawRate>(*content).w_radps, 0.3);
  }
}

TEST(ImuMessages, TheVerticalTellsWhichRateItIs) {
  const auto content =
      read_imu(Encoding::kRos1, imu_bytes(Encoding::kRos1, {0.1, -0.2, 0.3}), -Eigen::Vector3d::UnitY());
  ASSERT_TRUE(content.ok());
  EXPECT_NEAR(std::get<YawRate>(*content).w_radps, 0.2, 1e-15);
}

TEST(ImuMessages, GravityTellsWhichAxisIsVertical) {
  const auto vertical = [](const Eigen::Vector3d& a_mps2) {
    return vertical_by_gravity(imu_topic("/imu"), imu_bytes(Encoding::kRos1, {0.0, 0.0, 0.0}, 0.0, a_mps2));
  };
  EXPECT_EQ(vertical({0.5, 9.6, -0.2}), Eigen::Vector3d::UnitY());
  EXPECT_EQ(vertical({1.0, 2.0, -9.5}), -Eigen::Vector3d::UnitZ());
  EXPECT_EQ(vertical({2.0, 0.0, 0.0}), Eigen::Vector3d::UnitZ()) << "no gravity in it";
  EXPECT_EQ(vertical({NAN, 9.8, 0.0}), Eigen::Vector3d::UnitZ());
}

TEST(ImuMessages, RefusesWhatIsNotFiniteOrNotMeasured) {
  const auto infinite = read_imu(Encoding::kRos1, imu_bytes(Encoding::kRos1, {0.0, 0.0, INFINITY}));
  EXPECT_THAT(infinite.error().message, HasSubstr("not finite"));
  const auto missing = read_imu(Encoding::kRos1, imu_bytes(Encoding::kRos1, {0.0, 0.0, 0.0}, -1.0));
  EXPECT_THAT(missing.error().message, HasSubstr("no angular velocity"));
}

TEST(ImuMessages, TheRobotsOwnStandsBeforeThoseOfCameras) {
  EXPECT_LT(imu_rank(imu_topic("/imu/data")), imu_rank(imu_topic("/camera/gyro/sample")));
  EXPECT_LT(imu_rank(imu_topic("/camera/gyro/sample")), imu_rank(imu_topic("/camera/accel/sample")));
  EXPECT_LT(imu_rank({.name = "/imu", .type = "sensor_msgs/MagneticField"}), 0);
}

}  // namespace
}  // namespace waymark::bag
