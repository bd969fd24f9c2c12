#include "waymark/ekf/agreement.hpp"

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
struct Picture {
  RowMajor S;
  std::vector<Eigen::Vector2d> nu;
};

Picture random_picture(RandomStream& random, int sightings) {
  const int rows = 2 * sightings;
  Eigen::MatrixXd H(rows, 3);
  for (auto& entry : H.reshaped()) entry = 5.0 * random.normal();
  Picture picture{H * H.transpose() + Eigen::MatrixXd::Identity(rows, rows), {}};
  Eigen::VectorXd white(rows);
  for (double& entry : white) entry = random.normal();
  const Eigen::VectorXd nu = picture.S.llt().matrixL() * white;
  for (int k = 0; k < sightings; ++k) picture.nu.emplace_back(nu.segment<2>(2 * k));
  return picture;
}

/// The definition: an exact update of the innovations with sighting i, who is then within the gate, and what
/// that costs.
std::vector<char> brute_force(const Picture& picture) {
  const auto n = static_cast<int>(picture.nu.size());
  std::vector<char> best(picture.nu.size(), 0);
  double least = HUGE_VAL;
  for (int i = 0; i < n; ++i) {
    const auto& nu_i = picture.nu[static_cast<std::size_t>(i)];
    const Eigen::Matrix2d S_ii = picture.S.block<2, 2>(2 * i, 2 * i);
    double cost = nu_i.dot(S_ii.inverse() * nu_i);
    if (cost > kOwnGate) continue;
    const Eigen::MatrixXd K = picture.S.middleCols<2>(2 * i) * S_ii.inverse();
    const Eigen::MatrixXd after = picture.S - K * S_ii * K.transpose();
    std::vector<char> agrees(picture.nu.size(), 0);
    for (int j = 0; j < n; ++j) {
      const Eigen::Vector2d r = picture.nu[static_cast<std::size_t>(j)] - K.middleRows<2>(2 * j) * nu_i;
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

std::vector<char> best(Agreement& agreement, Picture picture) {
  picture.S.triangularView<Eigen::StrictlyUpper>().setConstant(std::nan(""));  // nobody may read it
  const auto found = agreement.best(picture.S, picture.nu, kOwnGate, kGate);
  return {found.begin(), found.end()};
}

TEST(Agreement, IsThePlainFormula) {
  RandomStream random(1, StreamPurpose::kWorld);
  Agreement agreement(32);
  int partial = 0;
  for (int k = 0; k < 300; ++k) {
    Picture picture = random_picture(random, 1 + k % 12);
    for (auto& nu : picture.nu)
      if (random.uniform() < 0.3) nu += Eigen::Vector2d(20.0 * random.normal(), 20.0 * random.normal());
    const auto expected = brute_force(picture);
    EXPECT_EQ(best(agreement, picture), expected);
    const auto count = static_cast<std::size_t>(std::ranges::count(expected, 1));
    if (count > 0 && count < expected.size()) ++partial;
  }
  EXPECT_GT(partial, 100);  // the interesting case
}

TEST(Agreement, LeavesOutWhatDoesNotFitTheCommonCause) {
  RandomStream random(2, StreamPurpose::kWorld);
  Agreement agreement(32);
  int wrongly_in = 0, wrongly_out = 0;
  constexpr int kPictures = 200;
  for (int k = 0; k < kPictures; ++k) {
    Picture picture = random_picture(random, 20);
    for (std::size_t i = 0; i < 4; ++i) picture.nu[i] += Eigen::Vector2d(60.0, -60.0);
    const auto agrees = best(agreement, picture);
    wrongly_in += static_cast<int>(std::count(agrees.begin(), agrees.begin() + 4, 1));
    wrongly_out += static_cast<int>(std::count(agrees.begin() + 4, agrees.end(), 0));
  }
  EXPECT_LT(wrongly_in, 0.05 * 4 * kPictures);
  EXPECT_LT(wrongly_out, 0.05 * 16 * kPictures);
}

TEST(Agreement, IsNobodyWhereNobodyIsWithinTheGate) {
  RandomStream random(3, StreamPurpose::kWorld);
  Agreement agreement(8);
  Picture picture = random_picture(random, 5);
  for (auto& nu : picture.nu) nu.setConstant(1e3);
  EXPECT_EQ(best(agreement, picture), std::vector<char>(5, 0));
  EXPECT_TRUE(best(agreement, {RowMajor(0, 0), {}}).empty());
}

TEST(Agreement, OfTwoThatDisagreeTakesTheLikelierOne) {
  Agreement agreement(4);
  const Picture picture{RowMajor::Identity(4, 4), {Eigen::Vector2d(3.5, 0.0), Eigen::Vector2d(1.0, 0.0)}};
  EXPECT_EQ(best(agreement, picture), (std::vector<char>{0, 1}));
}

TEST(Agreement, WrongPlacesThatAreShared) {
  // A brick on, at four standard deviations of what all have in common, against two where they should be.
  Agreement agreement(8);
  const auto with_wrong = [&](int wrong) {
    const int n = wrong + 2;
    Picture picture{RowMajor::Zero(2 * n, 2 * n), {}};
    for (int i = 0; i < 2 * n; ++i)
      for (int j = 0; j < 2 * n; ++j) picture.S(i, j) = (i % 2 == j % 2 ? 10.0 : 0.0) + (i == j ? 0.5 : 0.0);
    for (int k = 0; k < n; ++k) picture.nu.emplace_back(k < wrong ? 12.4 : -1.0, 0.3);
    return best(agreement, picture);
  };
  EXPECT_EQ(with_wrong(3), (std::vector<char>{0, 0, 0, 1, 1})) << "more, but not more likely";
  EXPECT_EQ(with_wrong(4), (std::vector<char>{1, 1, 1, 1, 0, 0})) << "so many cannot be chance";
  EXPECT_EQ(agreement.hypothesis(), 0U);
}

TEST(Agreement, WhatIsLeftOfASightingIsItsConditionalCovariance) {
  RandomStream random(5, StreamPurpose::kWorld);
  const Picture picture = random_picture(random, 4);
  const Eigen::Matrix2d S_10 = picture.S.block<2, 2>(2, 0);
  const Eigen::Matrix2d expected =
      picture.S.block<2, 2>(2, 2) - S_10 * picture.S.block<2, 2>(0, 0).inverse() * S_10.transpose();
  EXPECT_TRUE(Agreement::left_of(picture.S, 1, 0).isApprox(expected, 1e-12));
}

TEST(Agreement, TheRestIsWhatRemainsOfSomeWhereOneIsKnown) {
  RandomStream random(7, StreamPurpose::kWorld);
  Agreement agreement(32);
  const Picture picture = random_picture(random, 8);
  const std::vector<std::size_t> some{0, 2, 7};
  constexpr int kKnown = 3;
  const Eigen::Matrix2d S_ii = picture.S.block<2, 2>(2 * kKnown, 2 * kKnown);
  const Eigen::MatrixXd K = picture.S.middleCols<2>(2 * kKnown) * S_ii.inverse();
  const Eigen::MatrixXd after = picture.S - K * S_ii * K.transpose();
  const auto rest = agreement.rest(picture.S, picture.nu, kKnown, some);
  ASSERT_EQ(rest.S.rows(), 6);
  for (std::size_t a = 0; a < some.size(); ++a) {
    const auto at = static_cast<Eigen::Index>(2 * some[a]), row = static_cast<Eigen::Index>(2 * a);
    EXPECT_LT((rest.nu[a] - (picture.nu[some[a]] - K.middleRows<2>(at) * picture.nu[kKnown])).norm(), 1e-9);
    for (std::size_t b = 0; b <= a; ++b) {
      const auto other = static_cast<Eigen::Index>(2 * some[b]), column = static_cast<Eigen::Index>(2 * b);
      EXPECT_LT((rest.S.block<2, 2>(row, column) - after.block<2, 2>(at, other)).norm(), 1e-9);
    }
  }
}

/// Part of the pictures in which those that agree are said to do so by chance less than once in twenty.
double convincing(RandomStream& random, bool wrong_places) {
  constexpr int kPictures = 1000, kSightings = 10;
  constexpr double kAnywhere_px2 = 1e9;
  Agreement agreement(32);
  int convinced = 0;
  for (int k = 0; k < kPictures; ++k) {
    Picture picture = random_picture(random, kSightings);
    for (int i = 0; wrong_places && i < kSightings; ++i) {
      const double radius = std::sqrt(kOwnGate * random.uniform()), angle = random.uniform(0.0, 6.283185307);
      const Eigen::Matrix2d L = picture.S.block<2, 2>(2 * i, 2 * i).llt().matrixL();
      picture.nu[static_cast<std::size_t>(i)] =
          L * Eigen::Vector2d(radius * std::cos(angle), radius * std::sin(angle));
    }
    static_cast<void>(agreement.best(picture.S, picture.nu, kOwnGate, kGate));
    convinced += agreement.false_alarms(picture.S, kOwnGate, kGate, kAnywhere_px2) < 0.05;
  }
  return static_cast<double>(convinced) / kPictures;
}

TEST(Agreement, WrongPlacesHardlyEverAgreeAsConvincinglyAsRightOnes) {
  RandomStream random(8, StreamPurpose::kWorld);
  EXPECT_LT(convincing(random, true), 0.05);
  EXPECT_GT(convincing(random, false), 0.8);
}

TEST(Agreement, WhatIsNotPositiveDefiniteAgreesWithNothing) {
  Agreement agreement(4);
  Picture picture{RowMajor::Identity(6, 6), {{0.1, 0.0}, {0.1, 0.0}, {0.1, 0.0}}};
  picture.S.block<2, 2>(2, 2) *= -1.0;
  picture.S(4, 4) = std::nan("");
  EXPECT_EQ(best(agreement, picture), (std::vector<char>{1, 0, 0}));
}

TEST(Agreement, AllocatesNothing) {
  RandomStream random(4, StreamPurpose::kWorld);
  Agreement agreement(32);
  const Picture few = random_picture(random, 5);
  const Picture many = random_picture(random, 32);
  const test::AllocationCount count;
  for (const Picture* picture : {&many, &few, &many})
    (void)agreement.best(picture->S, picture->nu, kOwnGate, kGate);
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::ekf
