#include "workbench/sim/drive.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace waymark::sim {
namespace {

SimOptions without_slip(Shape shape = Shape::kSquare) {
  SimOptions options;
  options.path.shape = shape;
  options.wheels.slip_forward_var_m2_per_m = options.wheels.slip_lateral_var_m2_per_m = 0.0;
  options.wheels.slip_turn_var_rad2_per_rad = options.wheels.slip_turn_var_rad2_per_m = 0.0;
  return options;
}

Drive run(const SimOptions& options, std::uint64_t seed = 1) {
  return drive(make_path(options.path, seed), options, seed);
}

TEST(Drive, WithoutSlipTheRobotIsOnThePathAndComesBack) {
  for (const Shape shape : {Shape::kSquare, Shape::kLShape, Shape::kFigureEight, Shape::kRandom}) {
    const SimOptions options = without_slip(shape);
    const Path path = make_path(options.path, 1);
    const Drive driven = run(options);
    for (const DriveStep& step : driven.steps)
      EXPECT_LT(distance_m(path, step.T_world_robot.position()), 1e-9);
    EXPECT_LT(difference(driven.at(driven.end()), path.front().T_world_start).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(Drive, KeepsToItsSpeedAndTurnRate) {
  const SimOptions options = without_slip();
  for (const DriveStep& step : run(options).steps) {
    EXPECT_LE(step.command.distance_m * options.wheels.rate_hz, options.path.speed_mps + 1e-9);
    EXPECT_LE(std::abs(step.command.turn_rad) * options.wheels.rate_hz,
              to_radians(options.path.turn_rate_max_degps) + 1e-9);
  }
}

TEST(Drive, TakesTheTimeOfTheLap) {
  SimOptions options = without_slip();
  options.path.laps = 2;
  const Drive driven = run(options);
  // 24 m at 0.3 m/s and a full turn at 45 degrees/s.
  EXPECT_NEAR(to_seconds(driven.end()), 2.0 * (80.0 + 8.0), 1e-9);
  EXPECT_NEAR(to_seconds(driven.end()), 2.0 * lap_duration_s(make_path(options.path, 1), options), 1e-9);
}

TEST(Drive, StandsBeforeItDrives) {
  SimOptions options = without_slip();
  options.path.stand_s = 2.0;
  const Drive driven = run(options);
  EXPECT_EQ(driven.at(stamp_from_seconds(1.99)), driven.at(Stamp{}));
  EXPECT_NE(driven.at(stamp_from_seconds(2.5)), driven.at(Stamp{}));
  EXPECT_NEAR(to_seconds(driven.end()), 2.0 + 88.0, 1e-9);
}

TEST(Drive, WheelsThatSlipInTurnsTurnFartherThanTheRobot) {
  SimOptions options = without_slip();
  options.faults.turn_slip_ratio = 0.3;
  double wheels_rad = 0.0;
  double robot_rad = 0.0;
  for (const DriveStep& step : run(options).steps) {
    wheels_rad += step.command.turn_rad;
    robot_rad += step.command.turn_rad + step.slip.z();
    if (step.command.distance_m > 0.0) {
      EXPECT_EQ(step.slip.z(), 0.0) << "on straight lines";
    }
  }
  EXPECT_GT(wheels_rad - robot_rad, 0.05 * 2.0 * kPi);
  EXPECT_LT(wheels_rad - robot_rad, 0.3 * 2.0 * kPi);
}

TEST(Drive, SlipMovesTheRobotButItReturnsToThePath) {
  SimOptions options;
  options.path.laps = 5;
  options.wheels.slip_lateral_var_m2_per_m = 1e-4;
  options.wheels.slip_turn_var_rad2_per_m = 1e-3;
  const Path path = make_path(options.path, 1);
  double worst_m = 0.0;
  for (const DriveStep& step : run(options).steps) {
    worst_m = std::max(worst_m, distance_m(path, step.T_world_robot.position()));
  }
  EXPECT_GT(worst_m, 0.001);
  // Uncorrected, 120 m of this would end metres away.
  EXPECT_LT(worst_m, 0.3);
}

TEST(Drive, CoarseStepsStayStable) {
  SimOptions options;
  options.path.laps = 5;
  options.path.speed_mps = 1.0;
  options.wheels.rate_hz = 1.0;
  const Path path = make_path(options.path, 1);
  for (const DriveStep& step : run(options).steps)
    EXPECT_LT(distance_m(path, step.T_world_robot.position()), 0.5);
}

TEST(Drive, PoseBetweenTwoReadingsIsOnTheArcOfTheStep) {
  SimOptions options = without_slip(Shape::kFigureEight);
  options.wheels.rate_hz = 2.0;
  const Path path = make_path(options.path, 1);
  const Drive driven = run(options);
  const Stamp between = driven.stamp(7) + duration_from_seconds(0.123);
  EXPECT_LT(distance_m(path, driven.at(between).position()), 1e-9);
  EXPECT_GT((driven.at(between).position() - driven.at(driven.stamp(7)).position()).norm(), 0.03);
}

TEST(Drive, PoseAtAReadingIsThatOfItsStep) {
  SimOptions options;
  options.wheels.rate_hz = 30.0;  // no whole number of nanoseconds
  const Drive driven = run(options);
  for (std::size_t i = 0; i < driven.steps.size(); ++i) {
    EXPECT_LT(difference(driven.at(driven.stamp(i)), driven.steps[i].T_world_robot).cwiseAbs().maxCoeff(),
              1e-12);
  }
}

TEST(Drive, CornersAreWhereSidesEnd) {
  const Drive driven = run(without_slip());
  ASSERT_EQ(driven.corners.size(), 4u);
  const Pose2 first = driven.at(driven.stamp(driven.corners[0]));
  EXPECT_NEAR(first.x_m, 3.0, 1e-9);
  EXPECT_NEAR(first.y_m, 3.0, 1e-9);
}

// 0.005 m/s and 0.05 rad/s in every step of 0.1 s, on straight lines as in turns on the spot. A thousand
// draws tell a standard deviation to 2.2 %.
TEST(Drive, RobotOfTheReportErrsAsStatedPerStep) {
  SimOptions options = *scenario("report-l-shape");
  options.path.laps = 4;
  const Drive driven = drive(make_path(options.path, 1), options, 1);
  double forward = 0.0;
  double turn_straight = 0.0;
  double turn_on_spot = 0.0;
  int straight = 0;
  int on_spot = 0;
  for (const DriveStep& step : driven.steps) {
    const bool turns = std::abs(step.command.turn_rad) > 0.07;
    if (!turns) forward += step.slip.x() * step.slip.x();
    (turns ? turn_on_spot : turn_straight) += step.slip.z() * step.slip.z();
    ++(turns ? on_spot : straight);
  }
  ASSERT_GT(straight, 800);
  ASSERT_GT(on_spot, 100);
  EXPECT_NEAR(std::sqrt(forward / straight), 0.005 * 0.1, 5e-5);
  EXPECT_NEAR(std::sqrt(turn_straight / straight), 0.05 * 0.1, 5e-4);
  EXPECT_NEAR(std::sqrt(turn_on_spot / on_spot), 0.05 * 0.1, 1e-3);
}

}  // namespace
}  // namespace waymark::sim
