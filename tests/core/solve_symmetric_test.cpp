#include "waymark/core/solve_symmetric.hpp"

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/poses.hpp"

namespace waymark {
namespace {

using test::matrix_near;

TEST(SolveSymmetric, UndoesTheProduct) {
  RandomStream random(1, StreamPurpose::kSimulation);
  const Eigen::Matrix<double, 6, 6> A = test::random_covariance<6>(random, 1.0);
  const Eigen::Matrix<double, 6, 9> X = Eigen::Matrix<double, 6, 9>::Random();
  EXPECT_TRUE(matrix_near(solve_symmetric(A, A * X), X, 1e-9));
}

TEST(SolveSymmetric, GivesTheInverseOfNineRows) {
  RandomStream random(2, StreamPurpose::kSimulation);
  const Eigen::Matrix<double, 9, 9> A = test::random_covariance<9>(random, 1.0);
  const Eigen::Matrix<double, 9, 9> inverse = solve_symmetric(A, SmallMatrix::Identity(9, 9));
  EXPECT_TRUE(matrix_near(A * inverse, Eigen::Matrix<double, 9, 9>::Identity(), 1e-9));
}

TEST(SolveSymmetric, LeavesOutWhatASingularMatrixDoesNotTell) {
  const Eigen::Matrix2d A{{4.0, 0.0}, {0.0, 0.0}};
  const Eigen::Vector2d x = solve_symmetric(A, Eigen::Vector2d(8.0, 0.0));
  EXPECT_EQ(x, Eigen::Vector2d(2.0, 0.0));
}

}  // namespace
}  // namespace waymark
