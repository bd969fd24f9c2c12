#include "workbench/eval/nees.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "eval/eval_support.hpp"

namespace waymark::eval {
namespace {

TEST(Nees, IsTheQuadraticForm) {
  RandomStream random = test::random_stream(2);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Matrix3d A = Eigen::Matrix3d::NullaryExpr([&] { return random.normal(); });
    const Eigen::Matrix3d P = A * A.transpose() + 0.01 * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d e = Eigen::Vector3d::NullaryExpr([&] { return random.normal(); });
    const double expected = e.dot(P.inverse() * e);
    ASSERT_TRUE(nees<3>(e, P));
    EXPECT_NEAR(*nees<3>(e, P), expected, 1e-8 * expected);
  }
}

TEST(Nees, IgnoresUnits) {
  const Eigen::Matrix2d P{{4.0, 1.0}, {1.0, 1.0}};
  const Eigen::Vector2d to_mm(1000.0, 1.0);
  const Eigen::Matrix2d P_mm = to_mm.asDiagonal() * P * to_mm.asDiagonal();
  EXPECT_NEAR(*nees<2>({1.0, 2.0}, P), *nees<2>({1000.0, 2.0}, P_mm), 1e-12);
}

TEST(Nees, NothingWhereADirectionIsKnownExactly) {
  const Eigen::Vector3d e(1e-3, 1e-3, 1e-3);
  EXPECT_FALSE(nees<3>(e, Eigen::Matrix3d::Zero()));
  EXPECT_FALSE(nees<3>(e, Eigen::Matrix3d::Identity() * 1e-14));
  EXPECT_FALSE(nees<3>(e, Eigen::Matrix3d::Constant(std::nan(""))));
  EXPECT_FALSE(nees<3>(e, Eigen::Vector3d(1.0, -1.0, 1.0).asDiagonal()));
  // One step of two wheels: rank two, whatever rounding makes of it.
  const Eigen::Matrix<double, 3, 2> G{{0.7, 0.1}, {0.3, 0.4}, {0.2, 0.9}};
  EXPECT_FALSE(nees<3>(e, G * G.transpose()));
}

}  // namespace
}  // namespace waymark::eval
