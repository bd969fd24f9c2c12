#include "waymark/smooth/calibration.hpp"

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/poses.hpp"
#include "waymark/models/odometry.hpp"

#include "smooth/random_calibration.hpp"

namespace waymark::smooth {
namespace {

using test::matrix_near;
using test::numeric_jacobian;
using test::random_calibration;

TEST(Calibrate, MakesAnArcLongerAndTurnsItMore) {
  Calibration c = Calibration::Zero();
  c[kSpeedScale] = 0.1;
  c[kTurnScale] = -0.2;
  c[kTurnBias] = 0.03;
  const Pose2 measured = arc_increment({0.5, 0.4}, ArcModel::kExact);
  const Pose2 expected = arc_increment({0.55, 0.32 + 0.03 * 0.2}, ArcModel::kExact);
  EXPECT_TRUE(matrix_near(difference(calibrate(measured, 0.2, c).increment, expected),
                          Eigen::Vector3d::Zero(), 1e-14));
}

TEST(Calibrate, TurnsMorePerMetre) {
  Calibration c = Calibration::Zero();
  c[kTurnPerMetre] = 0.1;
  const Pose2 backwards = arc_increment({-0.5, 0.4}, ArcModel::kExact);
  const Pose2 expected = arc_increment({-0.5, 0.35}, ArcModel::kExact);
  EXPECT_TRUE(matrix_near(difference(calibrate(backwards, 0.2, c).increment, expected),
                          Eigen::Vector3d::Zero(), 1e-14));
}

TEST(Calibrate, LeavesAnIncrementAndARobotThatStandsAlone) {
  const Pose2 measured{0.3, -0.1, 0.2};
  EXPECT_TRUE(matrix_near(difference(calibrate(measured, 0.1, Calibration::Zero()).increment, measured),
                          Eigen::Vector3d::Zero(), 1e-15));
  EXPECT_EQ(calibrate({}, 0.1, Calibration::Constant(0.1)).increment, Pose2{});
}

TEST(Calibrate, JacobianAgreesWithCentralDifferences) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 100; ++i) {
    const Calibration c = random_calibration(random);
    const double turn_rad = i % 4 == 0 ? 1e-4 * random.uniform(-1.0, 1.0) : random.uniform(-2.5, 2.5);
    const Pose2 measured{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), turn_rad};
    const CalibratedMotion motion = calibrate(measured, 0.3, c);
    const auto increment = [&](const Calibration& v) {
      return difference(calibrate(measured, 0.3, v).increment, motion.increment);
    };
    EXPECT_TRUE(matrix_near(motion.J, numeric_jacobian(increment, c), 1e-8)) << turn_rad;
  }
}

TEST(ComposeCalibrated, JacobianAgreesWithCentralDifferences) {
  RandomStream random(2, StreamPurpose::kWorld);
  for (int i = 0; i < 30; ++i) {
    const Calibration c = random_calibration(random);
    const Pose2 a{0.4, 0.1, random.uniform(-1.0, 1.0)}, b{0.2, -0.3, random.uniform(-1.0, 1.0)};
    const auto both = [&](const Calibration& v) {
      return compose(calibrate(a, 0.1, v), calibrate(b, 0.2, v));
    };
    const CalibratedMotion motion = both(c);
    const auto increment = [&](const Calibration& v) {
      return difference(both(v).increment, motion.increment);
    };
    EXPECT_TRUE(matrix_near(motion.J, numeric_jacobian(increment, c), 1e-8));
  }
}

TEST(CalibrationSigmas, ComeFromBothSetsOfKeys) {
  SmoothOptions options;
  options.turn_bias_sigma_degps = 2.0;
  const Calibration sigmas =
      calibration_sigmas(options, {.shared_range_sigma_m = 0.4}, Observe::kRangeBearing);
  EXPECT_EQ(sigmas[kSpeedScale], options.speed_scale_sigma);
  EXPECT_EQ(sigmas[kTurnScale], options.turn_scale_sigma);
  EXPECT_NEAR(sigmas[kTurnBias], to_radians(2.0), 1e-15);
  EXPECT_EQ(sigmas[kRangeScale], 0.0);
  EXPECT_EQ(sigmas[kRangeOffset], 0.4);
}

TEST(CalibrationSigmas, OnlyTrustedRangesTellTheScaleOfDistances) {
  EXPECT_EQ(calibration_sigmas({}, {}, Observe::kBearing)[kSpeedScale], 0.0);
  EXPECT_EQ(calibration_sigmas({}, {.shared_range_sigma_ratio = 0.1}, Observe::kRange)[kSpeedScale], 0.0);
  EXPECT_GT(calibration_sigmas({}, {}, Observe::kRange)[kSpeedScale], 0.0);
}

}  // namespace
}  // namespace waymark::smooth
