#include "waymark/ekf/covariance.hpp"

#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/poses.hpp"
#include "waymark/core/random.hpp"

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
  [[nodiscard]] Touched any_jacobian() {
    Eigen::Matrix<double, 2, 3> J;
    for (auto& entry : J.reshaped()) entry = random_.normal();
    Touched touched(J, {}, 2);
    touched.set_landmark(3, 5, 2, J);
    return touched;
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

TEST_F(CovarianceTest, AppendsWhatIsLinear) {
  const Touched touched = any_jacobian();
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
  noise.topLeftCorner<2, 2>() = test::random_covariance<2>(random_);
  P_.append(P_.derive(touched, noise));
  Eigen::MatrixXd F(kValues + 2, kValues);
  F << Eigen::MatrixXd::Identity(kValues, kValues), dense(touched, kValues);
  Eigen::MatrixXd expected = F * before_ * F.transpose();
  expected.bottomRightCorner<2, 2>() += noise.topLeftCorner<2, 2>();
  EXPECT_TRUE(matrix_near(now(), expected, 1e-13));
}

TEST_F(CovarianceTest, PutsWhatIsLinearInThePlaceOfWhatItReplaces) {
  const Touched touched = any_jacobian();
  P_.replace(5, P_.derive(touched, Eigen::Matrix3d::Zero()));
  Eigen::MatrixXd F = Eigen::MatrixXd::Identity(kValues, kValues);
  F.middleRows<2>(5) = dense(touched, kValues);
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
