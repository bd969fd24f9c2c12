#include "waymark/smooth/selected_inverse.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "waymark/core/random.hpp"

namespace waymark::smooth {
namespace {

/// A chain with some far links and one dense row: positive definite.
SparseMatrix random_information(int size) {
  RandomStream random(5, StreamPurpose::kWorld);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * size, size);
  for (int i = 0; i < 2 * size; ++i)
    for (const int j : {i % size, (i + 1) % size, (7 * i) % size, size - 1}) A(i, j) += random.normal();
  const Eigen::MatrixXd H = A.transpose() * A + Eigen::MatrixXd::Identity(size, size);
  const Eigen::MatrixXd lower = H.triangularView<Eigen::Lower>();
  return lower.sparseView();
}

TEST(SelectedInverse, AgreesWithTheDenseInverseOnThePattern) {
  const SparseMatrix H = random_information(60);
  const SparseCholesky factor(H);
  const auto P = SelectedInverse::compute(factor, 1e9);
  ASSERT_TRUE(P.has_value());
  const Eigen::MatrixXd dense(H);
  const Eigen::MatrixXd whole = dense.selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd inverse = whole.inverse();
  int compared = 0;
  for (Eigen::Index column = 0; column < H.cols(); ++column)
    for (SparseMatrix::InnerIterator entry(H, column); entry; ++entry, ++compared) {
      EXPECT_NEAR((*P)(entry.row(), column), inverse(entry.row(), column), 1e-12);
      EXPECT_EQ((*P)(column, entry.row()), (*P)(entry.row(), column));
    }
  EXPECT_GT(compared, 200);
}

TEST(SelectedInverse, IsNotComputedWhereThatTakesTooLong) {
  const SparseCholesky factor(random_information(60));
  EXPECT_FALSE(SelectedInverse::compute(factor, 100.0).has_value());
}

}  // namespace
}  // namespace waymark::smooth
