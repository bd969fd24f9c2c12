#include "waymark/smooth/factors.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/poses.hpp"

#include "smooth/random_calibration.hpp"

namespace waymark::smooth {
namespace {

using test::matrix_near;
using test::numeric_jacobian;
using test::random_calibration;
using test::random_pose;
using test::to_pose;
using test::to_vector;

void expect_jacobians_of_odometry(bool by_errors, RandomStream& random) {
  const Pose2 before = random_pose(random), after = random_pose(random);
  const KeyframeInterval interval{{{{0.3, 0.0, 0.2}, 0.1}, {{0.2, 0.1, -0.4}, 0.2}}};
  const Calibration c = random_calibration(random);
  const auto factor_at = [&](const Pose2& a, const Pose2& b, const Calibration& v) {
    const OdometryFactor factor = linearize_odometry(a, b, motion_of(interval, v));
    return by_errors ? whiten_by_error_source(factor, {0.3, 0.7, 0.5}, v) : factor;
  };
  const OdometryFactor factor = factor_at(before, after, c);
  const auto of_before = [&](const Eigen::Vector3d& v) { return factor_at(to_pose(v), after, c).residual; };
  const auto of_after = [&](const Eigen::Vector3d& v) { return factor_at(before, to_pose(v), c).residual; };
  const auto of_calibration = [&](const Calibration& v) { return factor_at(before, after, v).residual; };
  EXPECT_TRUE(matrix_near(factor.J_before, numeric_jacobian(of_before, to_vector(before)), 1e-7));
  EXPECT_TRUE(matrix_near(factor.J_after, numeric_jacobian(of_after, to_vector(after)), 1e-7));
  EXPECT_TRUE(matrix_near(factor.J_calibration, numeric_jacobian(of_calibration, c), 1e-7));
}

TEST(OdometryFactor, JacobiansAgreeWithCentralDifferences) {
  RandomStream random(3, StreamPurpose::kWorld);
  for (int i = 0; i < 50; ++i)
    for (const bool by_errors : {false, true}) expect_jacobians_of_odometry(by_errors, random);
}

TEST(OdometryFactor, IsZeroWhereTheOdometryIsRight) {
  const Pose2 before{1.0, 2.0, 3.0}, moved{0.5, 0.1, -0.7};
  EXPECT_TRUE(matrix_near(linearize_odometry(before, before * moved, {moved}).residual,
                          Eigen::Vector3d::Zero(), 1e-14));
}

std::vector<ObservationEdge> all_kinds() {
  Eigen::Matrix2d R;
  R << 0.04, 0.01, 0.01, 0.09;
  const Eigen::Vector3d velocity(0.8, -0.1, 1.5);
  return {{0, 0, RangeBearing{5.0, 0.3}, R, velocity},
          {0, 0, Range{5.0}, R, velocity},
          {0, 0, Bearing{0.3}, R, velocity}};
}

TEST(ObservationFactor, JacobiansAgreeWithCentralDifferences) {
  RandomStream random(4, StreamPurpose::kWorld);
  const Pose2 mount{0.4, -0.2, 0.5};
  for (int i = 0; i < 50; ++i) {
    const Pose2 pose = random_pose(random);
    const Eigen::Vector2d p = pose * Eigen::Vector2d(random.uniform(2.0, 6.0), random.uniform(-5.0, 5.0));
    const Calibration c = random_calibration(random);
    for (const ObservationEdge& z : all_kinds()) {
      const ObservationFactor factor = linearize_observation(z, pose, mount, p, c);
      const auto residual = [&](const Pose2& T, const Eigen::Vector2d& q, const Calibration& v) {
        return linearize_observation(z, T, mount, q, v).residual;
      };
      const auto of_pose = [&](const Eigen::Vector3d& v) { return residual(to_pose(v), p, c); };
      const auto of_landmark = [&](const Eigen::Vector2d& v) { return residual(pose, v, c); };
      const auto of_calibration = [&](const Calibration& v) { return residual(pose, p, v); };
      EXPECT_TRUE(matrix_near(factor.J_pose, numeric_jacobian(of_pose, to_vector(pose)), 1e-6));
      EXPECT_TRUE(matrix_near(factor.J_landmark, numeric_jacobian(of_landmark, p), 1e-6));
      EXPECT_TRUE(matrix_near(factor.J_calibration, numeric_jacobian(of_calibration, c), 1e-6));
    }
  }
}

TEST(ObservationFactor, OfALateSensorIsFromWhereTheRobotWas) {
  const Eigen::Vector2d p(6.0, 1.0);
  ObservationEdge late{0, 0, RangeBearing{5.0, 0.3}, Eigen::Matrix2d::Identity(), {1.0, 0.0, 0.5}};
  Calibration c = Calibration::Zero();
  c[kDelay] = 0.2;
  const Pose2 now{2.0, 0.5, 0.3};
  const auto seen_before =
      linearize_observation(late, now * Pose2{-0.2, 0.0, -0.1}, {}, p, Calibration::Zero());
  EXPECT_TRUE(matrix_near(linearize_observation(late, now, {}, p, c).residual, seen_before.residual, 1e-12));
}

TEST(ObservationFactor, CountsInStandardDeviations) {
  Eigen::Matrix2d R;
  R << 0.04, 0.01, 0.01, 0.09;
  const Eigen::Vector2d p(5.5, 0.0);  // half a metre farther and 0.1 rad more to the right than measured
  const auto both = linearize_observation({0, 0, RangeBearing{5.0, 0.1}, R}, {}, {}, p, Calibration::Zero());
  const Eigen::Vector2d nu(0.5, -0.1);
  EXPECT_EQ(both.dof, 2);
  EXPECT_NEAR(both.residual.squaredNorm(), nu.dot(R.inverse() * nu), 1e-12);
  const auto range = linearize_observation({0, 0, Range{5.0}, R}, {}, {}, p, Calibration::Zero());
  EXPECT_EQ(range.dof, 1);
  EXPECT_NEAR(range.residual[0], 2.5, 1e-12);
  EXPECT_EQ(linearize_observation({0, 0, Range{5.0}, R}, {}, {}, {0.0, 0.0}, Calibration::Zero()).dof, 0);
}

}  // namespace
}  // namespace waymark::smooth
