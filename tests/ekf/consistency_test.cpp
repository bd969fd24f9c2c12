#include "waymark/ekf/consistency.hpp"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "waymark/core/pose2.hpp"

namespace waymark::ekf {
namespace {

using test::matrix_near;

/// V(a) is the mean of the rotations on the way from 0 to a.
TEST(Retraction, CarriesAPointAlongATurn) {
  const Eigen::Vector2d dq(1.0, -2.0);
  for (const double turn : {-2.0, -1e-3, 1e-7, 0.0, 0.4}) {
    constexpr int kSteps = 2000;
    Eigen::Vector2d expected = Eigen::Vector2d::Zero();
    for (int i = 0; i < kSteps; ++i) expected += rotation_matrix(turn * (i + 0.5) / kSteps) * dq / kSteps;
    const Retraction retraction(Consistency::kInvariant, turn);
    EXPECT_TRUE(retraction.turns());
    EXPECT_TRUE(matrix_near(retraction.displacement(dq), expected, 1e-6)) << turn;
    EXPECT_EQ(retraction.shear(dq), perpendicular(dq));
  }
}

TEST(Retraction, MovesPointsByTheirIncrementsInOtherFilters) {
  const Eigen::Vector2d dq(1.0, -2.0);
  for (const Consistency mode : {Consistency::kStandard, Consistency::kFej}) {
    const Retraction retraction(mode, 0.4);
    EXPECT_FALSE(retraction.turns());
    EXPECT_EQ(retraction.displacement(dq), dq);
    EXPECT_EQ(retraction.shear(dq), Eigen::Vector2d(0.0, 0.0));
  }
}

}  // namespace
}  // namespace waymark::ekf
