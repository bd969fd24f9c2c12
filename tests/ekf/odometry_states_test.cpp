#include "waymark/ekf/odometry_states.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "support/circle_world.hpp"
#include "support/matrix_near.hpp"
#include "waymark/ekf/ekf_slam.hpp"

namespace waymark {
namespace {

using test::CircleWorld;
using test::matrix_near;

/// What an odometry with these errors says of a motion.
Motion reported(const Motion& motion, const OdometryErrors& errors, double dt_s) {
  Motion wrong = motion;
  wrong.duration_s = dt_s;
  wrong.increment.theta_rad = (motion.increment.theta_rad - errors[2] * dt_s) / (1.0 + errors[1]);
  wrong.increment.x_m = motion.increment.x_m / (1.0 + errors[0]);
  return wrong;
}

EkfOptions calibrating() {
  EkfOptions options;
  options.capacity = 20;
  options.odometry = {true, 0.1, 0.1, 1.0};
  return options;
}

TEST(OdometryStates, LearnsAllThreeErrorsWithinWhatItSaysOfThem) {
  const OdometryErrors errors(0.08, -0.12, 0.01);
  Eigen::Vector3d d2 = Eigen::Vector3d::Zero();
  constexpr int kRuns = 30;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    CircleWorld world(seed);
    EkfSlam filter(calibrating(), world.sensor());
    for (int i = 0; i < 300; ++i) {
      filter.predict(reported(world.move(), errors, 0.1));
      filter.correct(world.look());
    }
    const auto learnt = filter.calibration();
    ASSERT_TRUE(learnt);
    const Eigen::Vector3d error = learnt->mean.head<3>() - errors;
    d2 += error.cwiseQuotient(learnt->sigmas.head<3>()).cwiseAbs2() / kRuns;
    EXPECT_LT(learnt->sigmas[kSpeedScale], 0.05);
  }
  // On one circle turn scale and rate cannot be told apart: each stays within its prior. 99.9 % band of a
  // mean of 30 chi-square variables of one degree of freedom.
  EXPECT_LT(d2.maxCoeff(), 4.0);
  EXPECT_LT(d2[0], 2.1);
  EXPECT_GT(d2[0], 0.35);
}

TEST(OdometryStates, ARobotThatOnlyStandsLearnsNothing) {
  CircleWorld world(1);
  EkfSlam filter(calibrating(), world.sensor());
  for (int i = 0; i < 20; ++i) {
    filter.predict({});
    filter.correct(world.look());
  }
  const auto learnt = filter.calibration();
  ASSERT_TRUE(learnt);
  const Eigen::Vector3d prior = calibrating().odometry.sigmas();
  EXPECT_TRUE(matrix_near(learnt->mean.head<3>(), Eigen::Vector3d::Zero(), 1e-15));
  EXPECT_TRUE(matrix_near(learnt->sigmas.head<3>(), prior, 1e-12));
  for (const CalibrationIndex index : {kSpeedScale, kTurnScale, kTurnBias})
    EXPECT_TRUE(learnt->is_unobservable(index));
}

TEST(OdometryStates, AreOffUnlessAskedFor) {
  CircleWorld world(1);
  EXPECT_FALSE(EkfSlam({}, world.sensor()).calibration());
}

}  // namespace
}  // namespace waymark
