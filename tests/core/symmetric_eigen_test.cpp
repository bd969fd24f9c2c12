#include "waymark/core/symmetric_eigen.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/poses.hpp"

namespace waymark {
namespace {

using test::matrix_near;

TEST(SymmetricEigen, TurnsTheMatrixDiagonal) {
  RandomStream random(1, StreamPurpose::kSimulation);
  const SmallMatrix A = test::random_covariance<9>(random, 1.0);
  const auto [values, V] = symmetric_eigen(A);
  EXPECT_TRUE(std::is_sorted(values.begin(), values.end()));
  EXPECT_TRUE(matrix_near(V * values.asDiagonal() * V.transpose(), A, 1e-12));
  EXPECT_TRUE(matrix_near(V.transpose() * V, SmallMatrix::Identity(9, 9), 1e-12));
}

}  // namespace
}  // namespace waymark
