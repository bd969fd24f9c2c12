#include "waymark/core/motion.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/poses.hpp"
#include "waymark/core/gaussian.hpp"

namespace waymark {
namespace {

using test::matrix_near;
using test::numeric_jacobian;
using test::random_covariance;
using test::random_pose;
using test::to_pose;
using test::to_vector;

Motion random_motion(RandomStream& random) {
  return {random_pose(random, 2.0), random_covariance<3>(random, 1e-2)};
}

TEST(Propagate, CarriesBothCovariancesThroughTheNumericJacobians) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 100; ++i) {
    const PoseEstimate before{random_pose(random), random_covariance<3>(random)};
    const Motion motion = random_motion(random);
    const PoseEstimate after = propagate(before, motion);
    const auto moved = [&](const Pose2& pose, const Pose2& increment) {
      return difference(pose * increment, after.T_world_robot);
    };
    const Eigen::Matrix3d F = numeric_jacobian(
        [&](const auto& v) { return moved(to_pose(v), motion.increment); }, to_vector(before.T_world_robot));
    const Eigen::Matrix3d G = numeric_jacobian(
        [&](const auto& v) { return moved(before.T_world_robot, to_pose(v)); }, to_vector(motion.increment));
    EXPECT_EQ(after.T_world_robot, before.T_world_robot * motion.increment);
    EXPECT_TRUE(matrix_near(after.covariance,
                            F * before.covariance * F.transpose() + G * motion.covariance * G.transpose(),
                            1e-7));
    EXPECT_EQ(after.covariance, after.covariance.transpose());
  }
}

TEST(Propagate, StandingStillChangesNothing) {
  RandomStream random(2, StreamPurpose::kWorld);
  const Pose2 pose = random_pose(random);
  const Eigen::Matrix3d P = random_covariance<3>(random);
  const PoseEstimate after = propagate({pose, 0.5 * (P + P.transpose())}, Motion{});
  EXPECT_TRUE(matrix_near(to_vector(after.T_world_robot), to_vector(pose), 1e-15));
  EXPECT_TRUE(matrix_near(after.covariance, P, 1e-15));
}

TEST(Propagate, HeadingErrorBecomesSidewaysErrorWithDistance) {
  PoseEstimate before;
  before.covariance(2, 2) = 0.01;
  const PoseEstimate after = propagate(before, {{5.0, 0.0, 0.0}, Eigen::Matrix3d::Zero()});
  EXPECT_NEAR(after.covariance(1, 1), 0.01 * 25.0, 1e-12);
  EXPECT_NEAR(after.covariance(1, 2), 0.01 * 5.0, 1e-12);
  EXPECT_NEAR(after.covariance(0, 0), 0.0, 1e-12);
}

TEST(Compose, ManySmallMotionsAreOne) {
  RandomStream random(3, StreamPurpose::kWorld);
  PoseEstimate step_by_step{random_pose(random), random_covariance<3>(random)};
  const PoseEstimate start = step_by_step;
  Motion whole;
  for (int i = 0; i < 200; ++i) {
    const Motion motion{random_pose(random, 0.1), random_covariance<3>(random, 1e-6)};
    step_by_step = propagate(step_by_step, motion);
    whole = compose(whole, motion);
  }
  const PoseEstimate at_once = propagate(start, whole);
  EXPECT_TRUE(matrix_near(difference(at_once.T_world_robot, step_by_step.T_world_robot),
                          Eigen::Vector3d::Zero(), 1e-12));
  EXPECT_TRUE(matrix_near(at_once.covariance, step_by_step.covariance, 1e-10));
}

TEST(Compose, IsAssociativeAndKeepsCovariances) {
  RandomStream random(4, StreamPurpose::kWorld);
  for (int i = 0; i < 50; ++i) {
    const Motion a = random_motion(random), b = random_motion(random), c = random_motion(random);
    const Motion left = compose(compose(a, b), c), right = compose(a, compose(b, c));
    EXPECT_TRUE(matrix_near(difference(left.increment, right.increment), Eigen::Vector3d::Zero(), 1e-13));
    EXPECT_TRUE(matrix_near(left.covariance, right.covariance, 1e-13));
    EXPECT_TRUE(is_covariance(left.covariance));
  }
}

TEST(Way, CountsTurnsToo) {
  EXPECT_EQ(travelled_m(Motion{}), 0.0);
  EXPECT_NEAR(travelled_m({{0.3, -0.4, 0.0}, {}}), 0.5, 1e-15);
  EXPECT_NEAR(travelled_m({{0.3, -0.4, -1.0}, {}}), 0.8, 1e-15);
}

TEST(IsStill, OnlyWithoutMotionAndWithoutNoise) {
  EXPECT_TRUE(is_still(Motion{}));
  EXPECT_FALSE(is_still({{1e-12, 0.0, 0.0}, Eigen::Matrix3d::Zero()}));
  EXPECT_FALSE(is_still({Pose2{}, 1e-12 * Eigen::Matrix3d::Identity()}));
}

TEST(IsFinite, AsksForEveryNumber) {
  EXPECT_TRUE(is_finite(Motion{Pose2{1.0, 2.0, 3.0}, Eigen::Matrix3d::Identity()}));
  for (int i = 0; i < 4; ++i) {
    Motion motion;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    if (i == 0) motion.increment.x_m = nan;
    if (i == 1) motion.increment.y_m = std::numeric_limits<double>::infinity();
    if (i == 2) motion.increment.theta_rad = nan;
    if (i == 3) motion.covariance(2, 1) = nan;
    EXPECT_FALSE(is_finite(motion)) << i;
  }
}

}  // namespace
}  // namespace waymark
