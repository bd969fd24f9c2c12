#include "waymark/ekf/one_point_ransac.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "waymark/core/random.hpp"

namespace waymark::ekf {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kOwnGate = 18.42;
constexpr double kGate = 9.21;

/// Innovations with a common cause of three values, as the robot's pose is, and noise of their own.
struct SimulatedImage {
  RowMajor S;
  std::vector<Eigen::Vector2d> nu;
};

SimulatedImage random_image(RandomStream& random, int linearizations) {
  const int rows = 2 * linearizations;
  Eigen::MatrixXd H(rows, 3);
  for (auto& entry : H.reshaped()) entry = 5.0 * random.normal();
  SimulatedImage image{H * H.transpose() + Eigen::MatrixXd::Identity(rows, rows), {}};
  Eigen::VectorXd white(rows);
  for (double& entry : white) entry = random.normal();
  const Eigen::VectorXd nu = image.S.llt().matrixL() * white;
  for (int k = 0; k < linearizations; ++k) image.nu.emplace_back(nu.segment<2>(2 * k));
  return image;
}

/// The definition: an exact update of the innovations with observation i, who is then within the gate, and
/// what that costs.
std::vector<char> brute_force(const SimulatedImage& image) {
  const auto n = static_cast<int>(image.nu.size());
  std::vector<char> best(image.nu.size(), 0);
  double least = HUGE_VAL;
  for (int i = 0; i < n; ++i) {
    const auto& nu_i = image.nu[static_cast<std::size_t>(i)];
    const Eigen::Matrix2d S_ii = image.S.block<2, 2>(2 * i, 2 * i);
    double cost = nu_i.dot(S_ii.inverse() * nu_i);
    if (cost > kOwnGate) continue;
    const Eigen::MatrixXd K = image.S.middleCols<2>(2 * i) * S_ii.inverse();
    const Eigen::MatrixXd after = image.S - K * S_ii * K.transpose();
    std::vector<char> agrees(image.nu.size(), 0);
    for (int j = 0; j < n; ++j) {
      const Eigen::Vector2d r = image.nu[static_cast<std::size_t>(j)] - K.middleRows<2>(2 * j) * nu_i;
      const double d2 = j == i ? 0.0 : r.dot(after.block<2, 2>(2 * j, 2 * j).inverse() * r);
      agrees[static_cast<std::size_t>(j)] = d2 <= kGate ? 1 : 0;
      cost += std::min(d2, kGate);
    }
    if (cost >= least) continue;
    best = agrees;
    least = cost;
  }
  return best;
}

std::vector<char> best(OnePointRansac& one_point_ransac, SimulatedImage image) {
  image.S.triangularView<Eigen::StrictlyUpper>().setConstant(std::nan(""));  // nobody may read it
  const auto found = one_point_ransac.best(image.S, image.nu, kOwnGate, kGate);
  return {found.begin(), found.end()};
}

TEST(OnePointRansac, IsThePlainFormula) {
  RandomStream random(1, StreamPurpose::kWorld);
  OnePointRansac one_point_ransac(32);
  int partial = 0;
  for (int k = 0; k < 300; ++k) {
    SimulatedImage image = random_image(random, 1 + k % 12);
    for (auto& nu : image.nu)
      if (random.uniform() < 0.3) nu += Eigen::Vector2d(20.0 * random.normal(), 20.0 * random.normal());
    const auto expected = brute_force(image);
    EXPECT_EQ(best(one_point_ransac, image), expected);
    const auto count = static_cast<std::size_t>(std::ranges::count(expected, 1));
    if (count > 0 && count < expected.size()) ++partial;
  }
  EXPECT_GT(partial, 100);  // the interesting case
}

TEST(OnePointRansac, LeavesOutWhatDoesNotFitTheCommonCause) {
  RandomStream random(2, StreamPurpose::kWorld);
  OnePointRansac one_point_ransac(32);
  int wrongly_in = 0, wrongly_out = 0;
  constexpr int kImages = 200;
  for (int k = 0; k < kImages; ++k) {
    SimulatedImage image = random_image(random, 20);
    for (std::size_t i = 0; i < 4; ++i) image.nu[i] += Eigen::Vector2d(60.0, -60.0);
    const auto agrees = best(one_point_ransac, image);
    wrongly_in += static_cast<int>(std::count(agrees.begin(), agrees.begin() + 4, 1));
    wrongly_out += static_cast<int>(std::count(agrees.begin() + 4, agrees.end(), 0));
  }
  EXPECT_LT(wrongly_in, 0.05 * 4 * kImages);
  EXPECT_LT(wrongly_out, 0.05 * 16 * kImages);
}

TEST(OnePointRansac, IsNobodyWhereNobodyIsWithinTheGate) {
  RandomStream random(3, StreamPurpose::kWorld);
  OnePointRansac one_point_ransac(8);
  SimulatedImage image = random_image(random, 5);
  for (auto& nu : image.nu) nu.setConstant(1e3);
  EXPECT_EQ(best(one_point_ransac, image), std::vector<char>(5, 0));
  EXPECT_TRUE(best(one_point_ransac, {RowMajor(0, 0), {}}).empty());
}

TEST(OnePointRansac, OfTwoThatDisagreeTakesTheLikelierOne) {
  OnePointRansac one_point_ransac(4);
  const SimulatedImage image{RowMajor::Identity(4, 4),
                             {Eigen::Vector2d(3.5, 0.0), Eigen::Vector2d(1.0, 0.0)}};
  EXPECT_EQ(best(one_point_ransac, image), (std::vector<char>{0, 1}));
}

TEST(OnePointRansac, WrongPlacesThatAreShared) {
  // A brick on, at four standard deviations of what all have in common, against two where they should be.
  OnePointRansac one_point_ransac(8);
  const auto with_wrong = [&](int wrong) {
    const int n = wrong + 2;
    SimulatedImage image{RowMajor::Zero(2 * n, 2 * n), {}};
    for (int i = 0; i < 2 * n; ++i)
      for (int j = 0; j < 2 * n; ++j) image.S(i, j) = (i % 2 == j % 2 ? 10.0 : 0.0) + (i == j ? 0.5 : 0.0);
    for (int k = 0; k < n; ++k) image.nu.emplace_back(k < wrong ? 12.4 : -1.0, 0.3);
    return best(one_point_ransac, image);
  };
  EXPECT_EQ(with_wrong(3), (std::vector<char>{0, 0, 0, 1, 1})) << "more, but not more likely";
  EXPECT_EQ(with_wrong(4), (std::vector<char>{1, 1, 1, 1, 0, 0})) << "so many cannot be chance";
}

TEST(OnePointRansac, WhatIsLeftOfAnObservationIsItsConditionalCovariance) {
  RandomStream random(5, StreamPurpose::kWorld);
  const SimulatedImage image = random_image(random, 4);
  const Eigen::Matrix2d S_10 = image.S.block<2, 2>(2, 0);
  const Eigen::Matrix2d expected =
      image.S.block<2, 2>(2, 2) - S_10 * image.S.block<2, 2>(0, 0).inverse() * S_10.transpose();
  EXPECT_TRUE(OnePointRansac::left_of(image.S, 1, 0).isApprox(expected, 1e-12));
}

TEST(OnePointRansac, TheRestIsWhatRemainsOfSomeWhereOneIsKnown) {
  RandomStream random(7, StreamPurpose::kWorld);
  OnePointRansac one_point_ransac(32);
  const SimulatedImage image = random_image(random, 8);
  const std::vector<std::size_t> some{0, 2, 7};
  constexpr int kKnown = 3;
  const Eigen::Matrix2d S_ii = image.S.block<2, 2>(2 * kKnown, 2 * kKnown);
  const Eigen::MatrixXd K = image.S.middleCols<2>(2 * kKnown) * S_ii.inverse();
  const Eigen::MatrixXd after = image.S - K * S_ii * K.transpose();
  const auto rest = one_point_ransac.rest(image.S, image.nu, kKnown, some);
  ASSERT_EQ(rest.S.rows(), 6);
  for (std::size_t a = 0; a < some.size(); ++a) {
    const auto at = static_cast<Eigen::Index>(2 * some[a]), row = static_cast<Eigen::Index>(2 * a);
    EXPECT_LT((rest.nu[a] - (image.nu[some[a]] - K.middleRows<2>(at) * image.nu[kKnown])).norm(), 1e-9);
    for (std::size_t b = 0; b <= a; ++b) {
      const auto other = static_cast<Eigen::Index>(2 * some[b]), column = static_cast<Eigen::Index>(2 * b);
      EXPECT_LT((rest.S.block<2, 2>(row, column) - after.block<2, 2>(at, other)).norm(), 1e-9);
    }
  }
}

/// Part of the images in which those that agree are said to do so by chance less than once in twenty.
double convincing(RandomStream& random, bool wrong_places) {
  constexpr int kImages = 1000, kObservations = 10;
  constexpr double kAnywhere_px2 = 1e9;
  OnePointRansac one_point_ransac(32);
  int convinced = 0;
  for (int k = 0; k < kImages; ++k) {
    SimulatedImage image = random_image(random, kObservations);
    for (int i = 0; wrong_places && i < kObservations; ++i) {
      const double radius = std::sqrt(kOwnGate * random.uniform()), angle = random.uniform(0.0, 6.283185307);
      const Eigen::Matrix2d L = image.S.block<2, 2>(2 * i, 2 * i).llt().matrixL();
      image.nu[static_cast<std::size_t>(i)] =
          L * Eigen::Vector2d(radius * std::cos(angle), radius * std::sin(angle));
    }
    static_cast<void>(one_point_ransac.best(image.S, image.nu, kOwnGate, kGate));
    convinced += one_point_ransac.false_alarms(image.S, kOwnGate, kGate, kAnywhere_px2) < 0.05;
  }
  return static_cast<double>(convinced) / kImages;
}

TEST(OnePointRansac, WrongPlacesHardlyEverAgreeAsConvincinglyAsRightOnes) {
  RandomStream random(8, StreamPurpose::kWorld);
  EXPECT_LT(convincing(random, true), 0.05);
  EXPECT_GT(convincing(random, false), 0.8);
}

TEST(OnePointRansac, WhatIsNotPositiveDefiniteAgreesWithNothing) {
  OnePointRansac one_point_ransac(4);
  SimulatedImage image{RowMajor::Identity(6, 6), {{0.1, 0.0}, {0.1, 0.0}, {0.1, 0.0}}};
  image.S.block<2, 2>(2, 2) *= -1.0;
  image.S(4, 4) = std::nan("");
  EXPECT_EQ(best(one_point_ransac, image), (std::vector<char>{1, 0, 0}));
}

TEST(OnePointRansac, AllocatesNothing) {
  RandomStream random(4, StreamPurpose::kWorld);
  OnePointRansac one_point_ransac(32);
  const SimulatedImage few = random_image(random, 5);
  const SimulatedImage many = random_image(random, 32);
  const test::AllocationCount count;
  for (const SimulatedImage* image : {&many, &few, &many})
    (void)one_point_ransac.best(image->S, image->nu, kOwnGate, kGate);
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::ekf
