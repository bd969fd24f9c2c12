#include "waymark/slam/jump_filter.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/stamps.hpp"
#include "waymark/core/angle.hpp"

namespace waymark {
namespace {

using test::at;

constexpr WheelGeometry kDrive{0.1, 0.1, 0.3};
constexpr double kStep_s = 0.05;

/// A circle of 2 m at 0.4 m/s, at 20 Hz.
Pose2 circle(int step) {
  const double theta_rad = 0.2 * kStep_s * step;
  return {2.0 * std::sin(theta_rad), 2.0 - 2.0 * std::cos(theta_rad), wrap_angle(theta_rad)};
}

/// The wheels on it.
WheelAngles circle_angles(int step) {
  const double t_s = kStep_s * step;
  return {3.7 * t_s, 4.3 * t_s};
}

double distance_m(const Pose2& a, const Pose2& b) { return (a.position() - b.position()).norm(); }

/// Readings at 20 Hz, continued.
template <class Value>
struct Continued {
  explicit Continued(const std::vector<Value>& readings) {
    for (std::size_t i = 0; i < readings.size(); ++i) {
      const Stamp stamp = at(kStep_s * static_cast<double>(i));
      values.push_back(filter.continued(stamp, readings[i]).value);
      filter.add(stamp, readings[i]);
    }
  }

  [[nodiscard]] const OdometryJumps& jumps() const { return filter.jumps(); }

  JumpFilter<Value> filter{kDrive};
  std::vector<Value> values;
};

std::vector<Pose2> circle_readings(int count) {
  std::vector<Pose2> readings;
  for (int i = 0; i < count; ++i) readings.push_back(circle(i));
  return readings;
}

std::vector<WheelAngles> wheel_readings(int count) {
  std::vector<WheelAngles> readings;
  for (int i = 0; i < count; ++i) readings.push_back(circle_angles(i));
  return readings;
}

TEST(JumpFilter, ReturnsReadingsBitByBitWhereNothingJumps) {
  const auto readings = circle_readings(1000);
  const Continued<Pose2> continued(readings);
  EXPECT_EQ(continued.values, readings);
  EXPECT_EQ(continued.jumps().resets.count + continued.jumps().outliers.count, 0);
}

TEST(JumpFilter, GoesOnOverAReset) {
  auto readings = circle_readings(400);
  for (int i = 200; i < 400; ++i) readings[static_cast<std::size_t>(i)] = circle(i - 200);
  const Continued<Pose2> continued(readings);
  EXPECT_LT(distance_m(continued.values.back(), circle(399)), 1e-3);
  EXPECT_NEAR(continued.values.back().theta_rad, circle(399).theta_rad, 1e-3);
  EXPECT_EQ(continued.jumps().resets.count, 1);
  EXPECT_EQ(continued.jumps().resets.first, at(10.0));
}

TEST(JumpFilter, IsNotSureOfTheStepOfAReset) {
  auto readings = circle_readings(200);
  Continued<Pose2> continued(readings);
  const auto reset = continued.filter.continued(at(10.0), Pose2{});
  EXPECT_NEAR(reset.sigma[0], 0.4 * kStep_s, 1e-4);
  EXPECT_NEAR(reset.sigma[2], 0.2 * kStep_s, 1e-4);
  EXPECT_TRUE(continued.filter.continued(at(10.0), circle(200)).sigma.isZero(0.0));
}

TEST(JumpFilter, LeavesOutReadingsThatAreFarOffForAMoment) {
  for (const Pose2 far : {Pose2{}, Pose2{50.0, -20.0, 1.0}}) {
    auto readings = circle_readings(400);
    readings[200] = readings[201] = far;
    const Continued<Pose2> continued(readings);
    EXPECT_EQ(continued.values.back(), circle(399));
    EXPECT_LT(distance_m(continued.values[200], circle(200)), 1e-3);
    EXPECT_EQ(continued.jumps().outliers.count, 2);
    EXPECT_EQ(continued.jumps().outliers.first, at(10.0));
    EXPECT_EQ(continued.jumps().resets.count, 0);
  }
}

TEST(JumpFilter, LeavesOutSeveralThatAreFarFromEachOther) {
  auto readings = circle_readings(400);
  readings[200] = {7.0, 0.0, 0.0};
  readings[201] = {-7.0, 3.0, 2.0};
  readings[203] = {100.0, 3.0, 2.0};
  const Continued<Pose2> continued(readings);
  EXPECT_EQ(continued.values.back(), circle(399));
  EXPECT_EQ(continued.jumps().outliers.count, 3);
  EXPECT_EQ(continued.jumps().resets.count, 0);
}

TEST(JumpFilter, BelievesARobotThatIsFastFromTheStart) {
  std::vector<Pose2> readings;
  for (int i = 0; i < 100; ++i) readings.push_back({1.5 * i, 0.0, 0.0});  // 30 m/s
  const Continued<Pose2> continued(readings);
  EXPECT_EQ(continued.values.back(), readings.back());
  EXPECT_EQ(continued.jumps().resets.count, 0);
}

TEST(JumpFilter, BelievesARobotThatReversesAtOnce) {
  std::vector<Pose2> readings;
  for (int i = 0; i < 40; ++i) readings.push_back({0.05 * (i < 20 ? i : 40 - i), 0.0, 0.0});
  const Continued<Pose2> continued(readings);
  EXPECT_EQ(continued.values, readings);
}

TEST(JumpFilter, BelievesStampsThatComeInBursts) {
  JumpFilter<Pose2> filter(kDrive);
  for (int i = 0; i < 400; ++i) {
    const int burst = i / 10;
    const Stamp stamp = at(0.5 * burst + 0.001 * (i % 10));
    EXPECT_EQ(filter.continued(stamp, circle(i)).value, circle(i));
    filter.add(stamp, circle(i));
  }
  EXPECT_EQ(filter.jumps().resets.count, 0);
}

TEST(JumpFilter, GoesOnOverACounterThatRollsOver) {
  auto readings = wheel_readings(400);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    readings[i].left_rad = std::fmod(readings[i].left_rad, 53.7);
    readings[i].right_rad = std::fmod(readings[i].right_rad, 53.7);
  }
  const Continued<WheelAngles> continued(readings);
  EXPECT_NEAR(continued.values.back().left_rad, circle_angles(399).left_rad, 1e-9);
  EXPECT_NEAR(continued.values.back().right_rad, circle_angles(399).right_rad, 1e-9);
  EXPECT_EQ(continued.jumps().resets.count, 2);
}

TEST(JumpFilter, UnwrapsWheelAngles) {
  for (const double lowest : {0.0, -kPi}) {
    auto readings = wheel_readings(400);
    for (auto& reading : readings)
      for (double* angle : {&reading.left_rad, &reading.right_rad})
        *angle -= 2.0 * kPi * std::floor((*angle - lowest) / (2.0 * kPi));
    const Continued<WheelAngles> continued(readings);
    EXPECT_NEAR(continued.values.back().left_rad, circle_angles(399).left_rad, 1e-9);
    EXPECT_NEAR(continued.values.back().right_rad, circle_angles(399).right_rad, 1e-9);
    EXPECT_EQ(continued.jumps().resets.count, 0);
    EXPECT_GT(continued.jumps().wraps.count, 20);
  }
}

TEST(JumpFilter, UnwrapsABinaryCounter) {
  JumpFilter<WheelAngles> filter({1e-3, 1e-3, 0.3});
  double last = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double told = std::fmod(20.0 * i, 65536.0);
    last = filter.continued(at(kStep_s * i), WheelAngles{told, told}).value.left_rad;
    filter.add(at(kStep_s * i), WheelAngles{told, told});
  }
  EXPECT_NEAR(last, 20.0 * 3999, 1e-6);
  EXPECT_EQ(filter.jumps().wraps.count, 1);
  EXPECT_EQ(filter.jumps().resets.count, 0);
}

TEST(JumpFilter, AStepOfMoreThanATurnIsNoWrap) {
  JumpFilter<WheelAngles> filter(kDrive);
  for (int i = 0; i < 20; ++i) {
    const double angle_rad = i < 10 ? 0.0 : 5.0 * (i - 9);
    EXPECT_EQ(filter.continued(at(1.0 * i), WheelAngles{angle_rad, angle_rad}).value.left_rad, angle_rad);
    filter.add(at(1.0 * i), WheelAngles{angle_rad, angle_rad});
  }
}

/// Speeds at 20 Hz; how many are used.
int accepted(SpeedFilter& filter, const std::vector<double>& speeds_mps) {
  int count = 0;
  for (std::size_t i = 0; i < speeds_mps.size(); ++i)
    count += filter.accept(at(kStep_s * static_cast<double>(i)), {speeds_mps[i], 0.2}) ? 1 : 0;
  return count;
}

TEST(SpeedFilter, LeavesOutSpeedsThatAreFarOffForAMoment) {
  SpeedFilter filter;
  EXPECT_EQ(accepted(filter, {0.4, 0.4, 40.0, 40.0, 0.4, -3.0, 0.4}), 4);
  EXPECT_EQ(filter.jumps().outliers.count, 3);
  EXPECT_EQ(filter.jumps().outliers.first, at(0.1));
  EXPECT_EQ(filter.fastest()[0], 0.4);
}

TEST(SpeedFilter, LeavesOutAFirstSpeedOfNoRobot) {
  SpeedFilter filter;
  EXPECT_EQ(accepted(filter, {655.35, 0.4, 0.4}), 2);
  EXPECT_EQ(filter.jumps().outliers.count, 1);
}

TEST(SpeedFilter, BelievesARobotThatStaysFast) {
  SpeedFilter filter;
  EXPECT_EQ(accepted(filter, {0.0, 20.0, 20.0, 20.0, 21.0}), 3);
  EXPECT_EQ(filter.jumps().outliers.count, 0);
}

}  // namespace
}  // namespace waymark
