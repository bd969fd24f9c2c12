#include "waymark/core/cholesky.hpp"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/poses.hpp"

namespace waymark {
namespace {

using test::matrix_near;

TEST(Cholesky, SolvesAndWhitens) {
  RandomStream random(1, StreamPurpose::kSimulation);
  const Eigen::MatrixXd S = test::random_covariance<12>(random, 1.0);
  const Eigen::MatrixXd B = test::random_covariance<12>(random, 1.0).leftCols(5);
  const Cholesky cholesky(S);
  ASSERT_TRUE(cholesky.is_positive_definite());
  EXPECT_TRUE(matrix_near(S * cholesky.solve(B), B, 1e-9));
  const Eigen::VectorXd b = B.col(0);
  EXPECT_TRUE(matrix_near(S * cholesky.solve(b), b, 1e-9));
  EXPECT_TRUE(matrix_near(cholesky.whiten(B).transpose() * cholesky.whiten(B),
                          B.transpose() * cholesky.solve(B), 1e-9));
  EXPECT_NEAR(cholesky.whiten(b).squaredNorm(), b.dot(cholesky.solve(b)), 1e-9);
  EXPECT_NEAR(cholesky.log_determinant(), std::log(S.determinant()), 1e-9);
}

TEST(Cholesky, RefusesWhatIsNotPositiveDefinite) {
  EXPECT_FALSE(Cholesky(Eigen::Vector2d(1.0, -1.0).asDiagonal()).is_positive_definite());
  EXPECT_FALSE(Cholesky(Eigen::MatrixXd::Constant(2, 2, std::nan(""))).is_positive_definite());
}

}  // namespace
}  // namespace waymark
