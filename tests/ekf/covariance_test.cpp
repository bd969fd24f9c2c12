#include "waymark/ekf/covariance.hpp"

#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/poses.hpp"
#include "waymark/core/aligned_array.hpp"
#include "waymark/core/random.hpp"
#include "waymark/ekf/state_layout.hpp"

#include "random_observations.hpp"

namespace waymark::ekf {
namespace {

using test::dense;
using test::matrix_near;

constexpr std::size_t kValues = 9;

class CovarianceTest : public testing::Test {
 protected:
  CovarianceTest() : P_(kValues, kValues + 6), before_(test::random_covariance<kValues>(random_)) {
    for (std::size_t i = 0; i < kValues; ++i)
      for (std::size_t j = i; j < kValues; ++j)
        P_.row(i)[j] = before_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }

  [[nodiscard]] Eigen::MatrixXd now() const {
    const auto n = static_cast<Eigen::Index>(P_.size());
    return Eigen::MatrixXd::NullaryExpr(n, n, [this](Eigen::Index i, Eigen::Index j) {
      return P_(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
    });
  }

  /// Depends on the robot and the values 5 and 6.
  [[nodiscard]] SparseJacobian any_jacobian() {
    Eigen::Matrix<double, 2, 3> J;
    for (auto& entry : J.reshaped()) entry = random_.normal();
    SparseJacobian jacobian(J, {}, 2);
    jacobian.set_landmark(3, 5, 2, J);
    return jacobian;
  }

  RandomStream random_{1, StreamPurpose::kWorld};
  Covariance P_;
  Eigen::Matrix<double, kValues, kValues> before_;
};

TEST_F(CovarianceTest, AnswersAsIfTheRobotsRowsWereJoined) {
  const Eigen::Vector2d phi(0.3, -0.2);
  P_.defer_to_robot_rows(0.5 * phi);
  P_.defer_to_robot_rows(0.5 * phi);
  Eigen::MatrixXd Phi = Eigen::MatrixXd::Identity(kValues, kValues);
  Phi.block<2, 1>(0, 2) = phi;
  Eigen::MatrixXd expected = Phi * before_ * Phi.transpose();
  expected.topLeftCorner<3, 3>() = before_.topLeftCorner<3, 3>();  // left to who moves the robot
  const Eigen::MatrixXd deferred = now();
  EXPECT_TRUE(matrix_near(deferred, expected, 1e-14));
  EXPECT_EQ(P_.propagate_cross_covariance(), phi);
  EXPECT_EQ(now(), deferred);
  EXPECT_EQ(P_.propagate_cross_covariance(), Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(now(), deferred);
}

/// Of a 3-D landmark that is relative to two anchors, with as many biases as there may be.
TEST(Covariance, ProjectsTheLargestObservation) {
  RandomStream random(2, StreamPurpose::kWorld);
  const StateLayout layout{3, bias_offset(kBiasTerms), 4};
  LinearizedObservation linearization = test::random_observation(random, 3, 3);
  linearization.anchor = 0;
  linearization.second_anchor = 2;
  for (auto& entry : linearization.H_second_anchor.reshaped()) entry = random.normal();
  for (int pair = 0; pair < kBiasTerms; ++pair) {
    BiasTerm& term = linearization.errors[static_cast<std::size_t>(pair)];
    term.pair = pair;
    for (auto& entry : term.J.reshaped()) entry = random.normal();
  }
  const SparseJacobian jacobian = layout.jacobian(linearization, 2);
  ASSERT_EQ(jacobian.size(), std::size_t{SparseJacobian::kMaxRows});
  constexpr int kSize = 9 + 3 * 4;
  ASSERT_EQ(layout.size(), std::size_t{kSize});
  const Eigen::Matrix<double, kSize, kSize> dense_P = test::random_covariance<kSize>(random);
  Covariance P(kSize, kSize);
  for (std::size_t i = 0; i < kSize; ++i)
    for (std::size_t j = i; j < kSize; ++j)
      P.row(i)[j] = dense_P(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  AlignedArray<double> C(2 * P.stride());
  P.project(jacobian, C.data(), P.stride());
  const Eigen::MatrixXd expected = dense(jacobian, kSize) * dense_P;
  for (int row = 0; row < 2; ++row)
    for (int j = 0; j < kSize; ++j)
      EXPECT_NEAR(C[static_cast<std::size_t>(row) * P.stride() + static_cast<std::size_t>(j)],
                  expected(row, j), 1e-11);
}

TEST_F(CovarianceTest, AppendsWhatIsLinear) {
  const SparseJacobian jacobian = any_jacobian();
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
  noise.topLeftCorner<2, 2>() = test::random_covariance<2>(random_);
  P_.append(P_.derive(jacobian, noise));
  Eigen::MatrixXd F(kValues + 2, kValues);
  F << Eigen::MatrixXd::Identity(kValues, kValues), dense(jacobian, kValues);
  Eigen::MatrixXd expected = F * before_ * F.transpose();
  expected.bottomRightCorner<2, 2>() += noise.topLeftCorner<2, 2>();
  EXPECT_TRUE(matrix_near(now(), expected, 1e-13));
}

TEST_F(CovarianceTest, PutsWhatIsLinearInThePlaceOfWhatItReplaces) {
  const SparseJacobian jacobian = any_jacobian();
  P_.replace(5, P_.derive(jacobian, Eigen::Matrix3d::Zero()));
  Eigen::MatrixXd F = Eigen::MatrixXd::Identity(kValues, kValues);
  F.middleRows<2>(5) = dense(jacobian, kValues);
  EXPECT_TRUE(matrix_near(now(), Eigen::MatrixXd(F * before_ * F.transpose()), 1e-13));
}

TEST_F(CovarianceTest, TheLastValuesTakeThePlaceOfRemovedOnes) {
  P_.remove(3, 2);
  const std::vector<int> left{0, 1, 2, 7, 8, 5, 6};
  EXPECT_EQ(now(), Eigen::MatrixXd(before_(left, left)));
  P_.remove(5, 2);
  const std::vector<int> first{0, 1, 2, 7, 8};
  EXPECT_EQ(now(), Eigen::MatrixXd(before_(first, first)));
}

}  // namespace
}  // namespace waymark::ekf
