#include "waymark/core/principal_axes.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/poses.hpp"

namespace waymark {
namespace {

using test::matrix_near;

TEST(PrincipalAxes, TurnTheMatrixDiagonal) {
  RandomStream random(1, StreamPurpose::kSimulation);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Matrix2d P = test::random_covariance<2>(random, 1.0);
    const auto [variances, directions] = principal_axes(P);
    EXPECT_LE(variances[0], variances[1]);
    EXPECT_TRUE(matrix_near(directions.transpose() * directions, Eigen::Matrix2d::Identity(), 1e-14));
    EXPECT_TRUE(matrix_near(directions * variances.asDiagonal() * directions.transpose(), P, 1e-13));
  }
}

TEST(PrincipalAxes, OfADiagonalMatrixAreThoseOfTheFrame) {
  const auto along_x = principal_axes(Eigen::Vector2d(9.0, 4.0).asDiagonal());
  EXPECT_EQ(along_x.variances, Eigen::Vector2d(4.0, 9.0));
  EXPECT_EQ(along_x.directions.col(1), Eigen::Vector2d(1.0, 0.0));
  const auto round = principal_axes(Eigen::Matrix2d::Identity());
  EXPECT_EQ(round.variances, Eigen::Vector2d(1.0, 1.0));
}

TEST(PrincipalAxes, OfWhatIsNoNumberAreNone) {
  EXPECT_FALSE(principal_axes(Eigen::Matrix2d::Constant(std::nan(""))).variances.allFinite());
}

}  // namespace
}  // namespace waymark
