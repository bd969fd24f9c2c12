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

/// The definition: an exact update of the innovations with sighting i, and who is then within the gate.
std::vector<char> brute_force(const Picture& picture, double gate) {
  const auto n = static_cast<int>(picture.nu.size());
  std::vector<char> best(picture.nu.size(), 0);
  int best_count = 0;
  double best_residual2 = 0.0;
  for (int i = 0; i < n; ++i) {
    const auto& nu_i = picture.nu[static_cast<std::size_t>(i)];
    const Eigen::Matrix2d S_ii = picture.S.block<2, 2>(2 * i, 2 * i);
    const double own = nu_i.dot(S_ii.inverse() * nu_i);
    if (own > gate) continue;
    const Eigen::MatrixXd K = picture.S.middleCols<2>(2 * i) * S_ii.inverse();
    const Eigen::MatrixXd after = picture.S - K * S_ii * K.transpose();
    std::vector<char> agrees(picture.nu.size(), 0);
    double residual2 = own;
    for (int j = 0; j < n; ++j) {
      const Eigen::Vector2d r = picture.nu[static_cast<std::size_t>(j)] - K.middleRows<2>(2 * j) * nu_i;
      const double d2 = j == i ? 0.0 : r.dot(after.block<2, 2>(2 * j, 2 * j).inverse() * r);
      if (d2 > gate) continue;
      agrees[static_cast<std::size_t>(j)] = 1;
      residual2 += d2;
    }
    const auto count = static_cast<int>(std::ranges::count(agrees, 1));
    if (count < best_count || (count == best_count && residual2 >= best_residual2)) continue;
    best = agrees;
    best_count = count;
    best_residual2 = residual2;
  }
  return best;
}

std::vector<char> largest(Agreement& agreement, Picture picture, double gate = kGate) {
  picture.S.triangularView<Eigen::StrictlyUpper>().setConstant(std::nan(""));  // nobody may read it
  const auto found = agreement.largest(picture.S, picture.nu, gate);
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
    const auto expected = brute_force(picture, kGate);
    EXPECT_EQ(largest(agreement, picture), expected);
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
    const auto agrees = largest(agreement, picture);
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
  EXPECT_EQ(largest(agreement, picture), std::vector<char>(5, 0));
  EXPECT_TRUE(largest(agreement, {RowMajor(0, 0), {}}).empty());
}

TEST(Agreement, OfEquallyLargeSetsTakesThatOfTheSmallerResiduals) {
  Agreement agreement(4);
  Picture picture{RowMajor::Identity(4, 4), {Eigen::Vector2d(3.5, 0.0), Eigen::Vector2d(1.0, 0.0)}};
  EXPECT_EQ(largest(agreement, picture), (std::vector<char>{0, 1}));
}

TEST(Agreement, WhatIsNotPositiveDefiniteAgreesWithNothing) {
  Agreement agreement(4);
  Picture picture{RowMajor::Identity(6, 6), {{0.1, 0.0}, {0.1, 0.0}, {0.1, 0.0}}};
  picture.S.block<2, 2>(2, 2) *= -1.0;
  picture.S(4, 4) = std::nan("");
  EXPECT_EQ(largest(agreement, picture), (std::vector<char>{1, 0, 0}));
}

TEST(Agreement, AllocatesNothing) {
  RandomStream random(4, StreamPurpose::kWorld);
  Agreement agreement(32);
  const Picture few = random_picture(random, 5);
  const Picture many = random_picture(random, 32);
  const test::AllocationCount count;
  for (const Picture* picture : {&many, &few, &many}) (void)agreement.largest(picture->S, picture->nu, kGate);
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::ekf
