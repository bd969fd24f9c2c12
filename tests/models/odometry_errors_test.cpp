#include "waymark/models/odometry_errors.hpp"

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/numeric_jacobian.hpp"
#include "waymark/core/random.hpp"
#include "waymark/models/odometry.hpp"

namespace waymark {
namespace {

using test::matrix_near;
using test::numeric_jacobian;

TEST(Corrected, IsWhatScalesOfTheOptionsWouldHaveMade) {
  const Velocity velocity{0.5, 0.4};
  OdometryOptions options;
  const Pose2 measured = velocity_motion(velocity, 0.2, options).increment;
  options.speed_scale = 1.1;
  options.turn_scale = 0.8;
  const Pose2 scaled = velocity_motion(velocity, 0.2, options).increment;
  const Pose2 actual = corrected(measured, 0.2, {0.1, -0.2, 0.0}).increment;
  EXPECT_TRUE(matrix_near(difference(actual, scaled), Eigen::Vector3d::Zero(), 1e-14));
}

TEST(Corrected, ARobotThatStandsStays) {
  EXPECT_EQ(corrected({}, 0.1, OdometryErrors::Constant(0.1)).increment, Pose2{});
}

TEST(Corrected, JacobianAgreesWithCentralDifferences) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 100; ++i) {
    const OdometryErrors errors(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1),
                                random.uniform(-0.1, 0.1));
    const double turn_rad = i % 4 == 0 ? 1e-4 * random.uniform(-1.0, 1.0) : random.uniform(-2.5, 2.5);
    const Pose2 measured{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), turn_rad};
    const CorrectedIncrement step = corrected(measured, 0.3, errors);
    const auto increment = [&](const OdometryErrors& v) {
      return difference(corrected(measured, 0.3, v).increment, step.increment);
    };
    EXPECT_TRUE(matrix_near(step.J, numeric_jacobian(increment, errors), 1e-8)) << turn_rad;
  }
}

}  // namespace
}  // namespace waymark
