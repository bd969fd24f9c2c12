#include "waymark/ekf/shear.hpp"

#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/poses.hpp"
#include "waymark/core/random.hpp"
#include "waymark/ekf/consistency.hpp"
#include "waymark/kernels/layout.hpp"

namespace waymark::ekf {
namespace {

using test::matrix_near;

// The robot, a pair of errors, and two landmarks of which the first is relative.
constexpr StateLayout kLayout{3, bias_offset(1), 2};
constexpr int kLayoutSize = 11;
const std::vector<char> kRelative{1, 0};

TEST(Shear, TurnsTheIncrementsOfGroundPointsOnly) {
  RandomStream random(1, StreamPurpose::kWorld);
  Eigen::VectorXd dx = Eigen::VectorXd::NullaryExpr(kLayoutSize, [&] { return random.normal(); });
  const Eigen::VectorXd before = dx;
  Shear shear(kLayoutSize);
  shear.turn(dx.data(), kLayout, kRelative);
  const Retraction retraction(Consistency::kInvariant, before[2]);
  Eigen::VectorXd expected = before;
  Eigen::VectorXd d = Eigen::VectorXd::Zero(kLayoutSize);
  for (const int at : {0, 8}) {
    expected.segment<2>(at) = retraction.displacement(before.segment<2>(at));
    d.segment<2>(at) = perpendicular(expected.segment<2>(at));
  }
  EXPECT_EQ(dx, expected);
  EXPECT_EQ((Eigen::Map<const Eigen::VectorXd>(shear.d(), kLayoutSize)), d);
}

/// P' + d e^T + e d^T = (I + d e_theta^T) P' (I + d e_theta^T)^T with P' = P - W^T W.
TEST(Shear, IsThatOfTheCorrectedCovariance) {
  RandomStream random(2, StreamPurpose::kWorld);
  const Eigen::MatrixXd before = test::random_covariance<kLayoutSize>(random);
  Covariance P(kLayoutSize, kLayoutSize);
  for (std::size_t i = 0; i < kLayoutSize; ++i)
    for (std::size_t j = i; j < kLayoutSize; ++j)
      P.row(i)[j] = before(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  constexpr int kRows = 3;
  AlignedArray<double> W(kRows * P.stride());
  Eigen::Map<Eigen::Matrix<double, kRows, kLayoutSize, Eigen::RowMajor>, 0, Eigen::OuterStride<>> panel(
      W.data(), Eigen::OuterStride<>(static_cast<Eigen::Index>(P.stride())));
  for (Eigen::Index i = 0; i < kRows; ++i)
    for (Eigen::Index j = 0; j < kLayoutSize; ++j) panel(i, j) = 0.1 * random.normal();
  Eigen::VectorXd dx = Eigen::VectorXd::NullaryExpr(kLayoutSize, [&] { return 0.1 * random.normal(); });
  Shear shear(kLayoutSize);
  shear.turn(dx.data(), kLayout, kRelative);
  shear.prepare(P, W.data(), P.stride(), kRows);
  const Eigen::Map<const Eigen::VectorXd> d(shear.d(), kLayoutSize), e(shear.e(), kLayoutSize);
  const Eigen::MatrixXd corrected = before - panel.transpose() * panel;
  Eigen::MatrixXd M = Eigen::MatrixXd::Identity(kLayoutSize, kLayoutSize);
  M.col(2) += d;
  EXPECT_TRUE(matrix_near(Eigen::MatrixXd(corrected + d * e.transpose() + e * d.transpose()),
                          Eigen::MatrixXd(M * corrected * M.transpose()), 1e-12));
}

}  // namespace
}  // namespace waymark::ekf
