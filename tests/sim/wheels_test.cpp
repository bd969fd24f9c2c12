#include "workbench/sim/wheels.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace waymark::sim {
namespace {

constexpr int kDraws = 20000;
// Five standard deviations of a sample variance: sqrt(2 / n) of its value.
constexpr double kVarianceBand = 5.0 * 0.01;

WheelOptions noisy() {
  WheelOptions wheels;
  wheels.var_m2_per_m = 2e-4;
  wheels.slip_forward_var_m2_per_m = 1e-4;
  wheels.slip_lateral_var_m2_per_m = 4e-4;
  wheels.slip_turn_var_rad2_per_rad = 1e-3;
  wheels.slip_turn_var_rad2_per_m = 3e-4;
  return wheels;
}

WheelOptions ideal_wheels() {
  WheelOptions wheels;
  wheels.var_m2_per_m = 0.0;
  wheels.slip_forward_var_m2_per_m = wheels.slip_lateral_var_m2_per_m = 0.0;
  wheels.slip_turn_var_rad2_per_rad = wheels.slip_turn_var_rad2_per_m = 0.0;
  return wheels;
}

TEST(Wheels, IdealEncodersAreUndoneByTheMotionModel) {
  RandomStream random(1, StreamPurpose::kSimulation);
  const ArcStep command{0.3, -0.2};
  const ArcStep counted =
      wheel_step(encoder_increment(ideal_wheels(), command, random), geometry(ideal_wheels()));
  EXPECT_NEAR(counted.distance_m, command.distance_m, 1e-15);
  EXPECT_NEAR(counted.turn_rad, command.turn_rad, 1e-15);
}

TEST(Wheels, NothingHappensAtRest) {
  RandomStream random(1, StreamPurpose::kSimulation);
  EXPECT_EQ(encoder_increment(noisy(), {}, random).left_rad, 0.0);
  EXPECT_EQ(encoder_increment(noisy(), {}, random).right_rad, 0.0);
  EXPECT_TRUE(draw_slip(noisy(), {}, random).isZero(0.0));
}

// Encoders and slip together must err as the motion model says: the sample covariance of (counted - moved) is
// its Q.
TEST(Wheels, ErrorsHaveTheCovarianceOfTheMotionModel) {
  const WheelOptions wheels = noisy();
  const ArcStep command{0.2, 0.5};
  const WheelAngles true_angles = [&] {
    RandomStream random(1, StreamPurpose::kSimulation);
    return encoder_increment(ideal_wheels(), command, random);
  }();
  const Motion expected =
      wheel_motion(true_angles, {.wheels = geometry(wheels), .noise = assumed_noise(wheels)});
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    RandomStream random(7, StreamPurpose::kSimulation, i);
    const ArcStep counted = wheel_step(encoder_increment(wheels, command, random), geometry(wheels));
    const Eigen::Vector3d error = difference(arc_increment(counted, ArcModel::kExact), expected.increment) -
                                  draw_slip(wheels, command, random);
    sum += error * error.transpose();
  }
  const Eigen::Matrix3d sample = sum / kDraws;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double scale = std::sqrt(expected.covariance(i, i) * expected.covariance(j, j));
      EXPECT_NEAR(sample(i, j), expected.covariance(i, j), kVarianceBand * scale) << i << "," << j;
    }
  }
}

// Without wheels in sight, the same variance has to be stated for distance and turn.
TEST(Wheels, AssumedNoiseOfVelocitiesEqualsThatOfWheelsOnAStraightLine) {
  WheelOptions wheels = noisy();
  const WheelAngles angles{2.0, 2.0};
  const Motion with_wheels =
      wheel_motion(angles, {.wheels = geometry(wheels), .noise = assumed_noise(wheels)});
  wheels.odometry = SimulatedOdometry::kVelocity;
  const Velocity velocity{wheel_step(angles, geometry(wheels)).distance_m, 0.0};
  const Motion without = velocity_motion(velocity, 1.0, {.wheels = {}, .noise = assumed_noise(wheels)});
  EXPECT_NEAR(without.covariance(0, 0), with_wheels.covariance(0, 0), 1e-12);
  EXPECT_NEAR(without.covariance(2, 2), with_wheels.covariance(2, 2), 1e-12);
}

TEST(Wheels, AssumedNoiseOfVelocitiesEqualsThatOfWheelsInATurnOnTheSpot) {
  WheelOptions wheels = noisy();
  const Motion with_wheels =
      wheel_motion({-1.0, 1.0}, {.wheels = geometry(wheels), .noise = assumed_noise(wheels)});
  wheels.odometry = SimulatedOdometry::kPose;
  const Pose2 turned{0.0, 0.0, wheel_step({-1.0, 1.0}, geometry(wheels)).turn_rad};
  const Motion without = odometry_pose_motion({}, turned, {.wheels = {}, .noise = assumed_noise(wheels)});
  EXPECT_NEAR(without.covariance(2, 2), with_wheels.covariance(2, 2), 1e-12);
}

}  // namespace
}  // namespace waymark::sim
