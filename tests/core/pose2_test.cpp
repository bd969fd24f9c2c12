#include "waymark/core/pose2.hpp"

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

constexpr double kTolerance = 1e-13;

testing::AssertionResult pose_near(const Pose2& actual, const Pose2& expected,
                                   double tolerance = kTolerance) {
  if (actual.theta_rad != wrap_angle(actual.theta_rad))
    return testing::AssertionFailure() << "heading " << actual.theta_rad << " is not wrapped";
  return matrix_near(difference(actual, expected), Eigen::Vector3d::Zero(), tolerance);
}

/// At the identity, next to it, and anywhere: `scale` shrinks a random pose.
class Pose2Group : public testing::TestWithParam<double> {
 protected:
  Pose2 any() { return to_pose(GetParam() * to_vector(random_pose(random_))); }
  RandomStream random_{1, StreamPurpose::kWorld};
};

TEST_P(Pose2Group, HasAnIdentity) {
  for (int i = 0; i < 100; ++i) {
    const Pose2 A = any();
    EXPECT_TRUE(pose_near(A * Pose2{}, A));
    EXPECT_TRUE(pose_near(Pose2{} * A, A));
  }
}

TEST_P(Pose2Group, HasInverses) {
  for (int i = 0; i < 100; ++i) {
    const Pose2 A = any(), B = any();
    EXPECT_TRUE(pose_near(A * A.inverse(), Pose2{}));
    EXPECT_TRUE(pose_near(A.inverse() * A, Pose2{}));
    EXPECT_TRUE(pose_near((A * B).inverse(), B.inverse() * A.inverse()));
  }
}

TEST_P(Pose2Group, IsAssociativeAndActsOnPoints) {
  for (int i = 0; i < 100; ++i) {
    const Pose2 A = any(), B = any(), C = any();
    const Eigen::Vector2d p = any().position();
    EXPECT_TRUE(pose_near((A * B) * C, A * (B * C)));
    EXPECT_TRUE(matrix_near((A * B) * p, A * (B * p), kTolerance));
    EXPECT_TRUE(matrix_near(A.inverse() * (A * p), p, kTolerance));
  }
}

TEST_P(Pose2Group, JacobiansAgreeWithCentralDifferences) {
  for (int i = 0; i < 100; ++i) {
    const Pose2 A = any(), B = any(), AB = A * B;
    const auto by_left = [&](const auto& v) { return difference(to_pose(v) * B, AB); };
    const auto by_right = [&](const auto& v) { return difference(A * to_pose(v), AB); };
    EXPECT_TRUE(matrix_near(compose_jacobian_left(A, B), numeric_jacobian(by_left, to_vector(A)), 1e-8));
    EXPECT_TRUE(matrix_near(compose_jacobian_right(A), numeric_jacobian(by_right, to_vector(B)), 1e-8));
  }
}

INSTANTIATE_TEST_SUITE_P(Scales, Pose2Group, testing::Values(0.0, 1e-8, 1.0));

TEST(Pose2, TurnsCounterClockwiseAndNamesCancel) {
  const Pose2 T_world_robot{1.0, 2.0, 0.5 * kPi};
  EXPECT_TRUE(matrix_near(T_world_robot * Eigen::Vector2d(3.0, 0.0), Eigen::Vector2d(1.0, 5.0), 1e-15));
  EXPECT_TRUE(pose_near(T_world_robot * Pose2{3.0, 0.0, kPi}, {1.0, 5.0, -0.5 * kPi}));
}

TEST(Pose2, HeadingsOfPiStayWrapped) {
  const Pose2 turned{1.0, 2.0, kPi};
  EXPECT_EQ(turned.inverse().theta_rad, kPi);
  EXPECT_EQ((turned * turned).theta_rad, 0.0);
  EXPECT_EQ(interpolate(turned, turned, 0.5).theta_rad, kPi);
}

TEST(Perpendicular, IsTheDerivativeOfRotation) {
  const Eigen::Vector2d v(0.3, -2.0);
  EXPECT_EQ(perpendicular({1.0, 0.0}), Eigen::Vector2d(0.0, 1.0));
  for (double angle = -3.0; angle <= 3.0; angle += 0.25) {
    const auto rotated = [&](const auto& a) -> Eigen::Vector2d { return rotation_matrix(a[0]) * v; };
    const Eigen::Vector2d derivative = numeric_jacobian(rotated, Eigen::Matrix<double, 1, 1>(angle));
    EXPECT_TRUE(matrix_near(perpendicular(rotation_matrix(angle) * v), derivative, 1e-8));
  }
}

TEST(Interpolate, GoesStraightAndTurnsTheShorterWayAcrossPi) {
  const Pose2 a{0.0, 2.0, to_radians(170.0)};
  const Pose2 b{4.0, 0.0, to_radians(-160.0)};
  EXPECT_TRUE(pose_near(interpolate(a, b, 0.0), a));
  EXPECT_TRUE(pose_near(interpolate(a, b, 1.0), b));
  EXPECT_TRUE(pose_near(interpolate(a, b, 0.25), {1.0, 1.5, to_radians(177.5)}));
  EXPECT_TRUE(pose_near(interpolate(a, b, 0.5), {2.0, 1.0, to_radians(-175.0)}));
  EXPECT_TRUE(pose_near(interpolate(b, a, 0.5), interpolate(a, b, 0.5)));
}

TEST(Difference, IsByCoordinateWithAWrappedTurn) {
  const Eigen::Vector3d d = difference({3.0, 1.0, to_radians(-170.0)}, {1.0, 2.0, to_radians(170.0)});
  EXPECT_TRUE(matrix_near(d, Eigen::Vector3d(2.0, -1.0, to_radians(20.0)), 1e-14));
}

}  // namespace
}  // namespace waymark
