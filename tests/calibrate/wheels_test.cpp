#include "workbench/calibrate/wheels.hpp"

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/numeric_jacobian.hpp"
#include "waymark/core/random.hpp"
#include "waymark/smooth/calibration.hpp"

namespace waymark::calibrate {
namespace {

using waymark::test::matrix_near;
using waymark::test::numeric_jacobian;

constexpr WheelGeometry kWheels{0.10, 0.102, 0.35};

Calibration random_odometry(RandomStream& random) {
  Calibration c = Calibration::Zero();
  for (const CalibrationIndex i : {kSpeedScale, kTurnScale, kTurnPerMetre}) c[i] = random.uniform(-0.1, 0.1);
  return c;
}

Eigen::Vector3d logarithms(const WheelGeometry& wheels) {
  return Eigen::Vector3d(wheels.left_radius_m, wheels.right_radius_m, wheels.track_m).array().log();
}

TEST(Wheels, CorrectedOnesMoveAsTheCalibratedOdometryDoes) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 50; ++i) {
    const Calibration c = random_odometry(random);
    const WheelAngles rolled{random.uniform(0.05, 0.1), random.uniform(0.05, 0.1)};
    const ArcStep before = wheel_step(rolled, kWheels);
    const ArcStep after = wheel_step(rolled, corrected(kWheels, c));
    EXPECT_NEAR(after.turn_rad,
                (1.0 + c[kTurnScale]) * before.turn_rad + c[kTurnPerMetre] * before.distance_m, 1e-14);
    // A larger right wheel goes a longer way in left turns: a part of a part, which the next run takes in.
    EXPECT_NEAR(after.distance_m, (1.0 + c[kSpeedScale]) * before.distance_m, 1e-4);
  }
}

TEST(Wheels, DeviationIsTheInverse) {
  RandomStream random(2, StreamPurpose::kWorld);
  for (int i = 0; i < 50; ++i) {
    const Calibration c = random_odometry(random);
    EXPECT_TRUE(matrix_near(deviation(kWheels, corrected(kWheels, c)), c, 1e-14));
  }
}

TEST(Wheels, JacobianAgreesWithCentralDifferences) {
  RandomStream random(3, StreamPurpose::kWorld);
  for (int i = 0; i < 50; ++i) {
    const Calibration c = random_odometry(random);
    const auto logs = [](const Calibration& v) { return logarithms(corrected(kWheels, v)); };
    EXPECT_TRUE(matrix_near(log_jacobian(kWheels, c), numeric_jacobian(logs, c), 1e-7));
  }
}

TEST(Wheels, WithScalesTakenInTheyMakeTheSameMotion) {
  OdometryOptions scaled{.wheels = kWheels};
  scaled.speed_scale = 1.1;
  scaled.turn_scale = 0.9;
  OdometryOptions plain{.wheels = with_scales(scaled)};
  const Motion a = wheel_motion({0.3, 0.5}, scaled), b = wheel_motion({0.3, 0.5}, plain);
  EXPECT_TRUE(matrix_near(difference(a.increment, b.increment), Eigen::Vector3d::Zero(), 1e-14));
}

}  // namespace
}  // namespace waymark::calibrate
