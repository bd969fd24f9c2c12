#include "waymark/core/gaussian.hpp"

#include <limits>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/poses.hpp"

namespace waymark {
namespace {

using test::random_covariance;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(IsCovariance, AcceptsWhatIsSymmetricAndNotNegative) {
  RandomStream random(1, StreamPurpose::kWorld);
  EXPECT_TRUE(is_covariance(Eigen::Matrix2d::Zero()));
  EXPECT_TRUE(is_covariance(Eigen::Matrix3d::Identity()));
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(is_covariance(random_covariance<5>(random, 1e-6)));
}

TEST(IsCovariance, AcceptsASingularMatrixDespiteRounding) {
  RandomStream random(2, StreamPurpose::kWorld);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector4d v(random.normal(), random.normal(), random.normal(), random.normal());
    EXPECT_TRUE(is_covariance(v * v.transpose()));
  }
}

TEST(IsCovariance, RefusesEverythingElse) {
  Eigen::Matrix3d P = Eigen::Matrix3d::Identity();
  P(0, 1) = 1e-6;
  EXPECT_FALSE(is_covariance(P)) << "not symmetric";
  EXPECT_FALSE(is_covariance(Eigen::Matrix2d{{1.0, 2.0}, {2.0, 1.0}})) << "correlation above one";
  EXPECT_FALSE(is_covariance(Eigen::Matrix2d{{1.0, 0.0}, {0.0, -1e-6}})) << "negative variance";
  EXPECT_FALSE(is_covariance(Eigen::Matrix2d{{1.0, kNaN}, {kNaN, 1.0}}));
  EXPECT_FALSE(is_covariance(Eigen::Matrix2d{{kInfinity, 0.0}, {0.0, 1.0}}));
  EXPECT_FALSE(is_covariance(Eigen::MatrixXd::Ones(2, 3)));
}

TEST(MahalanobisSquared, AgreesWithTheExplicitInverse) {
  RandomStream random(3, StreamPurpose::kWorld);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Matrix3d S = random_covariance<3>(random);
    const Eigen::Vector3d nu(random.normal(), random.normal(), random.normal());
    const double expected = nu.dot(S.inverse() * nu);
    const auto actual = mahalanobis_squared<3>(nu, S);
    ASSERT_TRUE(actual.has_value());
    EXPECT_NEAR(*actual, expected, 1e-9 * (1.0 + expected));
  }
}

TEST(MahalanobisSquared, WorksInOneAndInAnyNumberOfDimensions) {
  const Eigen::Matrix<double, 1, 1> nu(3.0);
  const Eigen::Matrix<double, 1, 1> S(4.0);
  EXPECT_DOUBLE_EQ(mahalanobis_squared<1>(nu, S).value(), 2.25);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(7);
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(7, 7);
  EXPECT_DOUBLE_EQ(mahalanobis_squared<Eigen::Dynamic>(ones, I).value(), 7.0);
}

TEST(MahalanobisSquared, IsNothingWhereSIsNotPositiveOrAnythingIsNotFinite) {
  const Eigen::Vector2d nu(1.0, 1.0);
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
  EXPECT_FALSE(mahalanobis_squared<2>(nu, Eigen::Matrix2d::Zero()).has_value());
  EXPECT_FALSE(mahalanobis_squared<2>(nu, -I).has_value());
  EXPECT_FALSE(mahalanobis_squared<2>(nu, Eigen::Matrix2d{{1.0, 2.0}, {2.0, 1.0}}).has_value());
  EXPECT_FALSE(mahalanobis_squared<2>(nu, kNaN * I).has_value());
  EXPECT_FALSE(mahalanobis_squared<2>(nu, Eigen::Matrix2d{{kInfinity, 0.0}, {0.0, 1.0}}).has_value());
  EXPECT_FALSE(mahalanobis_squared<2>(Eigen::Vector2d(kNaN, 0.0), I).has_value());
  EXPECT_FALSE(mahalanobis_squared<2>(Eigen::Vector2d(kInfinity, 0.0), I).has_value());
}

TEST(LogGaussian, IsTheLogOfTheDensity) {
  const Eigen::Vector2d nu(0.3, -0.2);
  const Eigen::Matrix2d S{{0.4, 0.1}, {0.1, 0.2}};
  const double density =
      std::exp(-0.5 * nu.dot(S.inverse() * nu)) / std::sqrt((2.0 * M_PI * S).determinant());
  EXPECT_NEAR(log_gaussian<2>(*mahalanobis_squared<2>(nu, S), S), std::log(density), 1e-12);
}

TEST(Gaussian, IsValidWithAFiniteMeanAndACovariance) {
  Gaussian<2> gaussian;
  EXPECT_TRUE(gaussian.is_valid());
  gaussian.mean[1] = kNaN;
  EXPECT_FALSE(gaussian.is_valid());
  gaussian.mean[1] = 0.0;
  gaussian.covariance(0, 0) = -1.0;
  EXPECT_FALSE(gaussian.is_valid());
}

}  // namespace
}  // namespace waymark
