#include "waymark/models/odometry.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/poses.hpp"
#include "waymark/core/gaussian.hpp"

namespace waymark {
namespace {

using test::matrix_near;
using test::numeric_jacobian;
using test::random_pose;
using test::to_vector;

constexpr WheelGeometry kWheels{0.05, 0.052, 0.3};
constexpr ArcModel kArcModels[] = {ArcModel::kExact, ArcModel::kArticle};

OdometryNoise no_noise() { return {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}; }

OdometryOptions with_noise(const OdometryNoise& noise) {
  OdometryOptions options;
  options.wheels = kWheels;
  options.noise = noise;
  return options;
}

/// Steps forward and back, with turns of both signs from 1e-9 to 3 rad and none at all.
std::vector<ArcStep> example_steps() {
  std::vector<ArcStep> steps;
  for (const double distance_m : {0.7, -1.3, 1e-3, 0.0}) {
    steps.push_back({distance_m, 0.0});
    for (double turn_rad = 1e-9; turn_rad <= 3.0; turn_rad *= 2.7) {
      steps.push_back({distance_m, turn_rad});
      steps.push_back({distance_m, -turn_rad});
    }
    // On both sides of where a series takes over.
    for (const double turn_rad : {0.999999e-4, 1.000001e-4, 3.0}) steps.push_back({distance_m, turn_rad});
  }
  return steps;
}

/// The unicycle dx/ds = cos(theta), dy/ds = sin(theta), dtheta/ds = const, integrated by Simpson's rule.
Pose2 integrate_unicycle(const ArcStep& step) {
  constexpr int kIntervals = 200;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i <= kIntervals; ++i) {
    const double weight = i == 0 || i == kIntervals ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    const double theta = step.turn_rad * i / kIntervals;
    sum += weight * Eigen::Vector2d(std::cos(theta), std::sin(theta));
  }
  const Eigen::Vector2d p = step.distance_m / (3.0 * kIntervals) * sum;
  return {p.x(), p.y(), step.turn_rad};
}

TEST(ArcIncrement, IsTheIntegralOfTheUnicycle) {
  for (const ArcStep& step : example_steps()) {
    const Eigen::Vector3d error = difference(arc_increment(step, ArcModel::kExact), integrate_unicycle(step));
    EXPECT_TRUE(matrix_near(error, Eigen::Vector3d::Zero(), 1e-9)) << step.distance_m << " " << step.turn_rad;
  }
}

TEST(ArcIncrement, ManySmallArcsAreOne) {
  for (const ArcStep& step : example_steps()) {
    Pose2 pose;
    for (int i = 0; i < 100; ++i)
      pose = pose * arc_increment({step.distance_m / 100.0, step.turn_rad / 100.0}, ArcModel::kExact);
    EXPECT_TRUE(
        matrix_near(difference(pose, arc_increment(step, ArcModel::kExact)), Eigen::Vector3d::Zero(), 1e-12));
  }
}

TEST(ArcIncrement, OfTheArticleIsAsLongAsTheArc) {
  const ArcStep step{0.5, 0.2};
  const Pose2 article = arc_increment(step, ArcModel::kArticle);
  const Pose2 exact = arc_increment(step, ArcModel::kExact);
  EXPECT_NEAR(article.position().norm(), 0.5, 1e-15);
  EXPECT_NEAR(article.position().norm() / exact.position().norm(), 0.1 / std::sin(0.1), 1e-12);
  EXPECT_NEAR(article.position().dot(exact.position()), article.position().norm() * exact.position().norm(),
              1e-15);
}

TEST(ArcIncrement, DrivingBackReturnsToTheStart) {
  for (const ArcModel model : kArcModels)
    for (const ArcStep& step : example_steps()) {
      const Pose2 there_and_back =
          arc_increment(step, model) * arc_increment({-step.distance_m, -step.turn_rad}, model);
      EXPECT_TRUE(matrix_near(to_vector(there_and_back), Eigen::Vector3d::Zero(), 1e-15));
    }
}

TEST(ArcIncrement, HeadingIsWrapped) {
  EXPECT_NEAR(arc_increment({0.0, 3.0 * kPi / 2.0}, ArcModel::kExact).theta_rad, -kPi / 2.0, 1e-15);
}

TEST(ArcJacobian, AgreesWithCentralDifferences) {
  for (const ArcModel model : kArcModels)
    for (const ArcStep& step : example_steps()) {
      const auto increment = [&](const Eigen::Vector2d& v) {
        return to_vector(arc_increment({v.x(), v.y()}, model));
      };
      const auto numeric = numeric_jacobian(increment, Eigen::Vector2d(step.distance_m, step.turn_rad));
      EXPECT_TRUE(matrix_near(arc_jacobian(step, model), numeric, 1e-8))
          << step.distance_m << " " << step.turn_rad;
    }
}

TEST(TurnedMore, IsTheArcOfTheSameLengthThatTurnsMore) {
  for (const ArcModel model : kArcModels)
    for (const ArcStep& step : example_steps())
      for (const double turn_rad : {-0.4, 1e-5, 0.3}) {
        const Pose2 more = turned_more(arc_increment(step, model), turn_rad, model);
        const Pose2 expected = arc_increment({step.distance_m, step.turn_rad + turn_rad}, model);
        EXPECT_TRUE(matrix_near(difference(more, expected), Eigen::Vector3d::Zero(), 1e-12))
            << step.distance_m << " " << step.turn_rad;
      }
}

TEST(WheelStep, AFasterRightWheelTurnsLeft) {
  const ArcStep turn = wheel_step({-1.0, 1.0}, {0.05, 0.05, 0.5});
  EXPECT_DOUBLE_EQ(turn.distance_m, 0.0);
  EXPECT_DOUBLE_EQ(turn.turn_rad, 0.2);
  const ArcStep straight = wheel_step({-2.0, -2.0}, {0.05, 0.05, 0.5});
  EXPECT_DOUBLE_EQ(straight.distance_m, -0.1);
  EXPECT_DOUBLE_EQ(straight.turn_rad, 0.0);
}

TEST(WheelJacobian, AgreesWithCentralDifferences) {
  const auto step = [](const Eigen::Vector2d& v) -> Eigen::Vector2d {
    const ArcStep s = wheel_step({v.x(), v.y()}, kWheels);
    return {s.distance_m, s.turn_rad};
  };
  EXPECT_TRUE(matrix_near(wheel_jacobian(kWheels), numeric_jacobian(step, Eigen::Vector2d(0.3, -0.8)), 1e-9));
}

/// Every way to make a motion, for the given whole step.
std::vector<Motion> all_motions(const ArcStep& step, const OdometryOptions& options) {
  const double half_turn_m = 0.5 * step.turn_rad * options.wheels.track_m;
  const WheelAngles wheels{(step.distance_m - half_turn_m) / options.wheels.left_radius_m,
                           (step.distance_m + half_turn_m) / options.wheels.right_radius_m};
  const Pose2 T_odom_before{3.0, -2.0, 2.9};
  return {wheel_motion(wheels, options),
          velocity_motion({2.0 * step.distance_m, 2.0 * step.turn_rad}, 0.5, options),
          odometry_pose_motion(T_odom_before, T_odom_before * arc_increment(step, options.arc), options)};
}

TEST(Motions, FromWheelsVelocitiesAndPosesAgree) {
  for (const ArcModel model : kArcModels)
    for (const ArcStep& step : example_steps()) {
      OdometryOptions options = with_noise({});
      options.arc = model;
      for (const Motion& motion : all_motions(step, options)) {
        const Eigen::Vector3d error = difference(motion.increment, arc_increment(step, model));
        EXPECT_TRUE(matrix_near(error, Eigen::Vector3d::Zero(), 1e-13))
            << step.distance_m << " " << step.turn_rad;
        EXPECT_TRUE(is_covariance(motion.covariance)) << motion.covariance;
      }
    }
}

TEST(Motions, StandingStillAddsNothing) {
  const OdometryOptions options = with_noise({});
  EXPECT_TRUE(is_still(wheel_motion({0.0, 0.0}, options)));
  EXPECT_TRUE(is_still(velocity_motion({0.0, 0.0}, 10.0, options)));
  EXPECT_TRUE(is_still(velocity_motion({1.0, 1.0}, 0.0, options)));
  EXPECT_TRUE(odometry_pose_motion({1.0, 2.0, 3.0}, {1.0, 2.0, 3.0}, options).covariance.isZero(1e-15));
}

TEST(Motions, BackwardDrivingIsAsUncertainAsForward) {
  const OdometryOptions options = with_noise({});
  for (const ArcStep& step : example_steps()) {
    const auto forward = all_motions(step, options);
    const auto backward = all_motions({-step.distance_m, -step.turn_rad}, options);
    // Mirrored front to back: x keeps its variance, y and theta swap their common sign.
    for (std::size_t i = 0; i < forward.size(); ++i)
      EXPECT_TRUE(matrix_near(backward[i].covariance.diagonal(), forward[i].covariance.diagonal(), 1e-12))
          << i;
  }
}

Motion in_steps(int count, const ArcStep& whole, std::size_t kind, const OdometryOptions& options) {
  Motion sum;
  for (int i = 0; i < count; ++i)
    sum = compose(sum, all_motions({whole.distance_m / count, whole.turn_rad / count}, options)[kind]);
  return sum;
}

TEST(Motions, NoiseOfAStraightDriveDoesNotDependOnTheNumberOfSteps) {
  OdometryNoise noise = no_noise();
  noise.forward_var_m2_per_m = 1e-3;
  noise.lateral_var_m2_per_m = 2e-3;
  const OdometryOptions options = with_noise(noise);
  for (std::size_t kind = 0; kind < 3; ++kind)
    EXPECT_TRUE(matrix_near(in_steps(100, {2.0, 0.0}, kind, options).covariance,
                            in_steps(1, {2.0, 0.0}, kind, options).covariance, 1e-12));
}

TEST(Motions, HeadingVarianceDoesNotDependOnTheNumberOfSteps) {
  const OdometryOptions options = with_noise({});
  for (const ArcStep& whole : {ArcStep{2.0, 0.0}, ArcStep{2.0, 1.5}, ArcStep{-1.0, 0.4}, ArcStep{0.0, -2.0}})
    for (std::size_t kind = 0; kind < 3; ++kind)
      EXPECT_NEAR(in_steps(100, whole, kind, options).covariance(2, 2),
                  in_steps(1, whole, kind, options).covariance(2, 2), 1e-12);
}

TEST(WheelMotion, ManyStepsConvergeToTheVarianceOfContinuousNoise) {
  // White noise q per metre in the heading of a straight line L: var(y) = q L^3 / 3, cov(y, theta) = q L^2
  // / 2.
  OdometryNoise noise = no_noise();
  noise.wheel_var_m2_per_m = 1e-4;
  const OdometryOptions options = with_noise(noise);
  const double q = 2.0 * noise.wheel_var_m2_per_m / (kWheels.track_m * kWheels.track_m);
  const Motion many = in_steps(200, {2.0, 0.0}, 0, options);
  EXPECT_NEAR(many.covariance(0, 0), 0.5 * noise.wheel_var_m2_per_m * 2.0, 1e-12);
  EXPECT_NEAR(many.covariance(2, 2), q * 2.0, 1e-12);
  EXPECT_NEAR(many.covariance(1, 2), q * 4.0 / 2.0, 1e-12);
  EXPECT_NEAR(many.covariance(1, 1), q * 8.0 / 3.0, 1e-4 * q);
  const Motion one = in_steps(1, {2.0, 0.0}, 0, options);
  EXPECT_NEAR(one.covariance(1, 2), many.covariance(1, 2), 1e-12);
}

TEST(WheelMotion, CarriesIndependentWheelErrorsThroughTheNumericJacobian) {
  OdometryNoise noise = no_noise();
  noise.wheel_var_m2_per_m = 3e-3;
  OdometryOptions options = with_noise(noise);
  options.speed_scale = 1.1;
  options.turn_scale = 0.8;
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d angles_rad(random.uniform(-20.0, 20.0), random.uniform(-20.0, 20.0));
    const Motion motion = wheel_motion({angles_rad.x(), angles_rad.y()}, options);
    const auto increment = [&](const Eigen::Vector2d& a) {
      return difference(wheel_motion({a.x(), a.y()}, options).increment, motion.increment);
    };
    const Eigen::Matrix<double, 3, 2> J = numeric_jacobian(increment, angles_rad);
    const Eigen::Vector2d radii_m(kWheels.left_radius_m, kWheels.right_radius_m);
    const Eigen::Vector2d variances_rad2 =
        noise.wheel_var_m2_per_m *
        angles_rad.cwiseAbs().cwiseProduct(radii_m).cwiseQuotient(radii_m.cwiseAbs2());
    EXPECT_TRUE(matrix_near(motion.covariance, J * variances_rad2.asDiagonal() * J.transpose(), 1e-9));
  }
}

TEST(VelocityMotion, SlipsAlongAndAcrossItsChord) {
  OdometryNoise noise = no_noise();
  noise.forward_var_m2_per_m = 4e-3;
  noise.lateral_var_m2_per_m = 1e-3;
  const OdometryOptions options = with_noise(noise);
  const Motion straight = velocity_motion({-0.5, 0.0}, 4.0, options);
  EXPECT_TRUE(
      matrix_near(straight.covariance, Eigen::Vector3d(8e-3, 2e-3, 0.0).asDiagonal().toDenseMatrix(), 1e-15));
  // A half turn ends straight to the left: along and across change places.
  const Motion half_turn = velocity_motion({0.5, kPi / 4.0}, 4.0, options);
  EXPECT_NEAR(half_turn.increment.x_m, 0.0, 1e-15);
  EXPECT_NEAR(half_turn.covariance(0, 0), 2e-3, 1e-15);
  EXPECT_NEAR(half_turn.covariance(0, 1), 0.0, 1e-15);
}

TEST(VelocityMotion, TurningInPlaceOnlyBlursTheHeading) {
  OdometryNoise noise = no_noise();
  noise.turn_var_rad2_per_rad = 0.01;
  const Motion motion = velocity_motion({0.0, -0.5}, 4.0, with_noise(noise));
  EXPECT_TRUE(
      matrix_near(motion.covariance, Eigen::Vector3d(0.0, 0.0, 0.02).asDiagonal().toDenseMatrix(), 1e-15));
}

TEST(Motions, ScalesCorrectDistanceAndTurn) {
  OdometryOptions options = with_noise({});
  options.speed_scale = 1.25;
  options.turn_scale = 0.5;
  for (const Motion& motion : all_motions({0.8, 0.0}, options))
    EXPECT_TRUE(matrix_near(to_vector(motion.increment), Eigen::Vector3d(1.0, 0.0, 0.0), 1e-14));
  for (const Motion& motion : all_motions({0.0, 0.6}, options))
    EXPECT_TRUE(matrix_near(to_vector(motion.increment), Eigen::Vector3d(0.0, 0.0, 0.3), 1e-14));
}

TEST(VelocityMotion, GoesInwardFromThePointWhoseSpeedIsReported) {
  OdometryOptions options;
  options.outer_point_m = 0.1;
  EXPECT_NEAR(velocity_motion({0.5, 0.0}, 1.0, options).increment.x_m, 0.5, 1e-15)
      << "straight on all are as fast";
  for (const double w_radps : {0.01, -0.01})
    EXPECT_NEAR(velocity_motion({0.5, w_radps}, 1.0, options).increment.x_m, 0.499, 1e-5);
  EXPECT_NEAR(velocity_motion({-0.5, 0.01}, 1.0, options).increment.x_m, -0.499, 1e-5);
  EXPECT_EQ(velocity_motion({0.02, 1.0}, 1.0, options).increment.position().norm(), 0.0)
      << "around a point beside it the robot turns on the spot";
}

constexpr CarGeometry kCar{2.83, 0.76};

OdometryOptions car_with_noise(const OdometryNoise& noise) {
  OdometryOptions options = with_noise(noise);
  options.car = kCar;
  return options;
}

TEST(CarStep, TurnsAboutThePointWhereTheAxlesMeet) {
  // The rear axle's middle goes on a circle of radius L / tan(steer), the wheel H left of it on R - H.
  for (const double steer_rad : {0.5, 0.03, -0.4}) {
    const double radius_m = kCar.wheel_base_m / std::tan(steer_rad);
    const ArcStep step = car_step(0.4 * std::abs(radius_m - kCar.encoder_offset_m), steer_rad, kCar);
    EXPECT_NEAR(step.turn_rad, std::copysign(0.4, steer_rad), 1e-12);
    EXPECT_NEAR(step.distance_m, 0.4 * std::abs(radius_m), 1e-12);
  }
  EXPECT_EQ(car_step(-0.7, 0.0, kCar).distance_m, -0.7);
  EXPECT_EQ(car_step(-0.7, 0.0, kCar).turn_rad, 0.0);
}

TEST(CarJacobian, AgreesWithCentralDifferences) {
  RandomStream random(5, StreamPurpose::kWorld);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d input(random.uniform(-3.0, 3.0), random.uniform(-0.7, 0.7));
    const auto step = [](const Eigen::Vector2d& v) -> Eigen::Vector2d {
      const ArcStep s = car_step(v.x(), v.y(), kCar);
      return {s.distance_m, s.turn_rad};
    };
    EXPECT_TRUE(matrix_near(car_jacobian(input.x(), input.y(), kCar), numeric_jacobian(step, input), 1e-8));
  }
}

TEST(SteeringMotion, CarriesTheErrorsOfSpeedAndSteeringThroughTheNumericJacobian) {
  OdometryNoise noise = no_noise();
  noise.wheel_var_m2_per_m = 3e-3;
  noise.steer_var_rad2_m = 2e-4;
  OdometryOptions options = car_with_noise(noise);
  options.speed_scale = 1.1;
  options.turn_scale = 0.8;
  RandomStream random(6, StreamPurpose::kWorld);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d input(random.uniform(-8.0, 8.0), random.uniform(-0.6, 0.6));
    const double dt_s = random.uniform(0.01, 0.2);
    const Motion motion = steering_motion({input.x(), input.y()}, dt_s, options);
    const auto increment = [&](const Eigen::Vector2d& v) {
      return difference(steering_motion({v.x(), v.y()}, dt_s, options).increment, motion.increment);
    };
    const Eigen::Matrix<double, 3, 2> J = numeric_jacobian(increment, input);
    const double rolled_m = std::abs(input.x()) * dt_s;
    const Eigen::Vector2d variances(3e-3 * rolled_m / (dt_s * dt_s), 2e-4 / rolled_m);
    EXPECT_TRUE(matrix_near(motion.covariance, J * variances.asDiagonal() * J.transpose(), 1e-8));
  }
}

TEST(SteeringMotion, HeadingVarianceDoesNotDependOnTheNumberOfSteps) {
  const OdometryOptions options = car_with_noise({});
  for (const Steering steering : {Steering{3.0, 0.0}, Steering{-2.0, 0.4}, Steering{5.0, -0.2}}) {
    Motion many;
    for (int i = 0; i < 50; ++i) many = compose(many, steering_motion(steering, 0.02, options));
    EXPECT_NEAR(many.covariance(2, 2), steering_motion(steering, 1.0, options).covariance(2, 2), 1e-12);
  }
}

TEST(SteeringMotion, ACarThatStandsIsStillHoweverItSteers) {
  EXPECT_TRUE(is_still(steering_motion({0.0, 0.5}, 10.0, car_with_noise({}))));
  EXPECT_TRUE(is_still(steering_motion({3.0, 0.5}, 0.0, car_with_noise({}))));
}

TEST(OdometryPoseMotion, DoesNotDependOnTheOdometryFrame) {
  const OdometryOptions options = with_noise({});
  RandomStream random(2, StreamPurpose::kWorld);
  for (int i = 0; i < 100; ++i) {
    const Pose2 before = random_pose(random), increment = random_pose(random, 0.5),
                T_map_odom = random_pose(random);
    const Motion here = odometry_pose_motion(before, before * increment, options);
    const Motion there = odometry_pose_motion(T_map_odom * before, T_map_odom * before * increment, options);
    EXPECT_TRUE(matrix_near(difference(here.increment, increment), Eigen::Vector3d::Zero(), 1e-13));
    EXPECT_TRUE(matrix_near(difference(there.increment, increment), Eigen::Vector3d::Zero(), 1e-13));
    EXPECT_TRUE(matrix_near(there.covariance, here.covariance, 1e-13));
  }
}

TEST(OdometryPoseMotion, KeepsAScaledTurnWrapped) {
  OdometryOptions options = with_noise({});
  options.turn_scale = 2.0;
  EXPECT_NEAR(odometry_pose_motion({}, {0.0, 0.0, 2.0}, options).increment.theta_rad, 4.0 - 2.0 * kPi, 1e-14);
}

TEST(CheckWheels, NamesTheKeyThatIsMissing) {
  EXPECT_TRUE(check(kWheels).ok());
  EXPECT_TRUE(check({0.0, 0.1, 0.3}).error().message.starts_with("wheels.left_radius_m "));
  EXPECT_TRUE(check({0.1, 0.0, 0.3}).error().message.starts_with("wheels.right_radius_m "));
  EXPECT_TRUE(check({0.1, 0.1, std::nan("")}).error().message.starts_with("wheels.track_m "));
}

TEST(CheckCar, NamesTheKeyThatIsMissing) {
  EXPECT_TRUE(check(kCar).ok());
  EXPECT_TRUE(check(CarGeometry{}).error().message.starts_with("car.wheel_base_m "));
}

TEST(Odometry, ATurnKnownOtherwiseLeavesTheWayAndTheRestOfItsCovariance) {
  const Motion told = velocity_motion({0.5, 0.4}, 1.0, {});
  const Motion turned = turned_as_measured(told, 0.6, 1e-6, ArcModel::kExact);
  EXPECT_NEAR(turned.increment.theta_rad, 0.6, 1e-12);
  EXPECT_NEAR(arc_length_m(turned.increment, ArcModel::kExact), 0.5, 1e-12);
  EXPECT_NEAR(turned.covariance(2, 2), 1e-6, 1e-12);
  // Without the turn's error: what is left of x and y when it is known.
  const Eigen::Vector3d with_turn = told.covariance.col(2) / told.covariance(2, 2);
  const Eigen::Matrix3d given = told.covariance - told.covariance(2, 2) * with_turn * with_turn.transpose();
  const Eigen::Matrix3d expected = given + 1e-6 * with_turn * with_turn.transpose();
  EXPECT_LT((turned.covariance - expected).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Odometry, ATurnOfARobotThatStandsIsOneOnTheSpot) {
  const Motion turned = turned_as_measured({}, 0.1, 1e-6, ArcModel::kExact);
  EXPECT_EQ(turned.increment.position(), Eigen::Vector2d::Zero());
  EXPECT_NEAR(turned.increment.theta_rad, 0.1, 1e-12);
  EXPECT_EQ(turned.covariance, Eigen::Matrix3d(Eigen::Vector3d(0.0, 0.0, 1e-6).asDiagonal()));
}

}  // namespace
}  // namespace waymark
