#include "waymark/models/observation_models.hpp"

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/poses.hpp"

namespace waymark {
namespace {

using test::matrix_near;
using test::numeric_jacobian;
using test::random_pose;
using test::to_pose;
using test::to_vector;

constexpr double kPlanarTolerance = 1e-6;

struct ObservedScene {
  Pose2 T_world_robot;
  Pose2 T_robot_sensor;
  Eigen::Vector2d p_world;
};

/// A robot anywhere, a sensor up to a metre off its origin, a landmark 0.3 m to 10 m from the sensor in any
/// direction.
ObservedScene random_scene(RandomStream& random) {
  const Pose2 T_world_robot = random_pose(random);
  const Pose2 T_robot_sensor = random_pose(random, 1.4);
  const Eigen::Vector2d ray(random.uniform(0.3, 10.0), 0.0);
  return {T_world_robot, T_robot_sensor,
          T_world_robot * T_robot_sensor * Pose2{0.0, 0.0, random.uniform(-kPi, kPi)} * ray};
}

/// The predicted measurement of the simplest form: the landmark in the sensor's own frame, in polar
/// coordinates.
Eigen::Vector2d plain_prediction(const ObservedScene& scene) {
  const Eigen::Vector2d p_sensor = (scene.T_world_robot * scene.T_robot_sensor).inverse() * scene.p_world;
  return {p_sensor.norm(), std::atan2(p_sensor.y(), p_sensor.x())};
}

Eigen::Vector2d polar_difference(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return {a.x() - b.x(), wrap_angle(a.y() - b.y())};
}

TEST(RangeBearingModel, PredictsPolarCoordinatesInTheSensorFrame) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 500; ++i) {
    const ObservedScene scene = random_scene(random);
    const auto h = RangeBearingModel::linearize(scene.T_world_robot, scene.T_robot_sensor, scene.p_world);
    EXPECT_TRUE(
        matrix_near(polar_difference(h.predicted, plain_prediction(scene)), Eigen::Vector2d::Zero(), 1e-12));
    EXPECT_TRUE(h.predicted.y() > -kPi && h.predicted.y() <= kPi);
  }
}

TEST(RangeBearingModel, JacobiansAgreeWithCentralDifferences) {
  RandomStream random(2, StreamPurpose::kWorld);
  for (int i = 0; i < 500; ++i) {
    const ObservedScene scene = random_scene(random);
    const auto h = RangeBearingModel::linearize(scene.T_world_robot, scene.T_robot_sensor, scene.p_world);
    const auto by_pose = [&](const Eigen::Vector3d& v) {
      return polar_difference(plain_prediction({to_pose(v), scene.T_robot_sensor, scene.p_world}),
                              h.predicted);
    };
    const auto by_landmark = [&](const Eigen::Vector2d& p) {
      return polar_difference(plain_prediction({scene.T_world_robot, scene.T_robot_sensor, p}), h.predicted);
    };
    EXPECT_TRUE(
        matrix_near(h.H_pose, numeric_jacobian(by_pose, to_vector(scene.T_world_robot)), kPlanarTolerance));
    EXPECT_TRUE(matrix_near(h.H_landmark, numeric_jacobian(by_landmark, scene.p_world), kPlanarTolerance));
  }
}

TEST(RangeBearingModel, LocateIsTheInverseOfThePrediction) {
  RandomStream random(3, StreamPurpose::kWorld);
  for (int i = 0; i < 500; ++i) {
    const auto [T_world_robot, T_robot_sensor, p_world] = random_scene(random);
    const auto h = RangeBearingModel::linearize(T_world_robot, T_robot_sensor, p_world);
    const RangeBearing z{h.predicted.x(), h.predicted.y()};
    const auto located = RangeBearingModel::locate(T_world_robot, T_robot_sensor, z);
    EXPECT_TRUE(matrix_near(located.p_world, p_world, 1e-12));
    EXPECT_TRUE(matrix_near(T_world_robot * T_robot_sensor * position_in_sensor(z), p_world, 1e-12));
    // h(x, g(x, z)) = z for all x and z, so H_pose + H_landmark G_pose = 0 and H_landmark G_measurement = 1.
    EXPECT_TRUE(
        matrix_near(h.H_pose + h.H_landmark * located.G_pose, Eigen::Matrix<double, 2, 3>::Zero(), 1e-11));
    EXPECT_TRUE(matrix_near(h.H_landmark * located.G_measurement, Eigen::Matrix2d::Identity(), 1e-11));
  }
}

TEST(RangeBearingModel, JacobiansOfLocateAgreeWithCentralDifferences) {
  RandomStream random(4, StreamPurpose::kWorld);
  for (int i = 0; i < 500; ++i) {
    const Pose2 T_world_robot = random_pose(random);
    const Pose2 T_robot_sensor = random_pose(random, 1.4);
    const Eigen::Vector2d z(random.uniform(0.3, 10.0), random.uniform(-kPi, kPi));
    const auto located = RangeBearingModel::locate(T_world_robot, T_robot_sensor, {z.x(), z.y()});
    const auto by_pose = [&](const Eigen::Vector3d& v) {
      return RangeBearingModel::locate(to_pose(v), T_robot_sensor, {z.x(), z.y()}).p_world;
    };
    const auto by_measurement = [&](const Eigen::Vector2d& v) {
      return RangeBearingModel::locate(T_world_robot, T_robot_sensor, {v.x(), v.y()}).p_world;
    };
    EXPECT_TRUE(
        matrix_near(located.G_pose, numeric_jacobian(by_pose, to_vector(T_world_robot)), kPlanarTolerance));
    EXPECT_TRUE(matrix_near(located.G_measurement, numeric_jacobian(by_measurement, z), kPlanarTolerance));
  }
}

TEST(RangeBearingModel, DoesNotFeelAMoveOfTheWholeWorld) {
  RandomStream random(5, StreamPurpose::kWorld);
  for (int i = 0; i < 100; ++i) {
    const auto [T_world_robot, T_robot_sensor, p_world] = random_scene(random);
    const Pose2 T_map_world = random_pose(random);
    const auto here = RangeBearingModel::linearize(T_world_robot, T_robot_sensor, p_world);
    const auto there =
        RangeBearingModel::linearize(T_map_world * T_world_robot, T_robot_sensor, T_map_world * p_world);
    EXPECT_TRUE(
        matrix_near(polar_difference(here.predicted, there.predicted), Eigen::Vector2d::Zero(), 1e-12));
  }
}

TEST(ObservationModels, InnovationsWrap) {
  const auto both = RangeBearingModel::innovation({3.0, to_radians(179.0)}, {2.5, to_radians(-179.0)});
  EXPECT_TRUE(matrix_near(both, Eigen::Vector2d(0.5, to_radians(-2.0)), 1e-14));
  const Eigen::Matrix<double, 1, 1> predicted(to_radians(-179.0));
  EXPECT_NEAR(BearingModel::innovation({to_radians(179.0)}, predicted)(0), to_radians(-2.0), 1e-14);
  EXPECT_NEAR(BearingModel::innovation({to_radians(900.0)}, predicted)(0), to_radians(-1.0), 1e-14);
}

TEST(RangeModel, IsTheFirstRowOfRangeBearing) {
  RandomStream random(6, StreamPurpose::kWorld);
  const auto [T_world_robot, T_robot_sensor, p_world] = random_scene(random);
  const auto both = RangeBearingModel::linearize(T_world_robot, T_robot_sensor, p_world);
  const auto range = RangeModel::linearize(T_world_robot, T_robot_sensor, p_world);
  EXPECT_EQ(range.predicted, both.predicted.head<1>());
  EXPECT_EQ(range.H_pose, both.H_pose.row(0));
  EXPECT_EQ(range.H_landmark, both.H_landmark.row(0));
  EXPECT_DOUBLE_EQ(RangeModel::innovation({4.0}, Eigen::Matrix<double, 1, 1>(1.5))(0), 2.5);
}

TEST(BearingModel, IsTheSecondRowOfRangeBearing) {
  RandomStream random(7, StreamPurpose::kWorld);
  const auto [T_world_robot, T_robot_sensor, p_world] = random_scene(random);
  const auto both = RangeBearingModel::linearize(T_world_robot, T_robot_sensor, p_world);
  const auto bearing = BearingModel::linearize(T_world_robot, T_robot_sensor, p_world);
  EXPECT_EQ(bearing.predicted, both.predicted.tail<1>());
  EXPECT_EQ(bearing.H_pose, both.H_pose.row(1));
  EXPECT_EQ(bearing.H_landmark, both.H_landmark.row(1));
}

}  // namespace
}  // namespace waymark
