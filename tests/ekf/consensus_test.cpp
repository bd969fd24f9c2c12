#include "waymark/ekf/consensus.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"

namespace waymark::ekf {
namespace {

constexpr double kObservationGate = 18.42;
constexpr double kImage_px2 = 320.0 * 240.0;

/// Observations with their joint covariance.
struct Observations {
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> S;
  std::vector<Eigen::Vector2d> nu;
};

/// All have one cause in common, of which each coordinate has variance `common_px2`.
Observations of_one_cause(double common_px2, double own_px2, const std::vector<Eigen::Vector2d>& nu) {
  const auto rows = static_cast<Eigen::Index>(2 * nu.size());
  Observations all{own_px2 * Eigen::MatrixXd::Identity(rows, rows), nu};
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index j = 0; j < rows; ++j)
      if (i % 2 == j % 2) all.S(i, j) += common_px2;
  return all;
}

/// Those that are well known, and independently of them those that come back.
Observations together(const Observations& known, const Observations& back) {
  const Eigen::Index m = known.S.rows(), n = back.S.rows();
  Observations all{Eigen::MatrixXd::Zero(m + n, m + n), known.nu};
  all.S.topLeftCorner(m, m) = known.S;
  all.S.bottomRightCorner(n, n) = back.S;
  all.nu.insert(all.nu.end(), back.nu.begin(), back.nu.end());
  return all;
}

std::vector<Outcome> judge(const Observations& linearizations) {
  Consensus consensus(32, kObservationGate, kImage_px2);
  const auto outcomes = consensus.judge(linearizations.S, linearizations.nu);
  return {outcomes.begin(), outcomes.end()};
}

std::vector<Eigen::Vector2d> times(std::size_t count, double u, double v = 0.0) {
  return std::vector<Eigen::Vector2d>(count, Eigen::Vector2d(u, v));
}

TEST(Consensus, ThoseThatAgreeAreMatchedAndTheOthersGated) {
  std::vector<Eigen::Vector2d> nu = times(5, 2.0, 1.0);
  nu[3] = {-4.0, 1.0};
  std::vector<Outcome> expected(5, Outcome::kMatched);
  expected[3] = Outcome::kGated;
  EXPECT_EQ(judge(of_one_cause(5.0, 0.5, nu)), expected);
  EXPECT_EQ(judge(of_one_cause(5.0, 0.5, times(1, 1.0))), std::vector{Outcome::kMatched});
}

TEST(Consensus, OfTwoThatContradictEachOtherNeitherIsBelieved) {
  EXPECT_EQ(judge(of_one_cause(5.0, 0.5, {{2.0, 0.0}, {-4.0, 0.0}})), std::vector(2, Outcome::kGated));
}

TEST(Consensus, OneOrTwoInAWideSearchSayNothing) {
  EXPECT_EQ(judge(of_one_cause(30.0, 0.5, times(1, 2.0))), std::vector(1, Outcome::kUnusable));
  EXPECT_EQ(judge(of_one_cause(30.0, 0.5, times(2, 2.0))), std::vector(2, Outcome::kUnusable));
  EXPECT_EQ(judge(of_one_cause(30.0, 0.5, times(3, 2.0))), std::vector(3, Outcome::kMatched));
  EXPECT_EQ(judge(of_one_cause(10.0, 0.5, times(1, 2.0))), std::vector(1, Outcome::kMatched))
      << "not so wide";
}

TEST(Consensus, WhatComesBackNeedsThreeThatSayTheSame) {
  const Observations known = of_one_cause(0.5, 0.5, times(4, 0.5));
  for (const std::size_t count : {1U, 2U, 3U, 4U}) {
    std::vector<Outcome> expected(4, Outcome::kMatched);
    expected.resize(4 + count, count < 3 ? Outcome::kUnusable : Outcome::kMatched);
    EXPECT_EQ(judge(together(known, of_one_cause(50.0, 0.5, times(count, 7.0)))), expected) << count;
  }
}

TEST(Consensus, WhatComesBackFromVeryFarMustAgreeMoreThanByChance) {
  const Observations known = of_one_cause(0.5, 0.5, times(4, 0.5));
  const auto back = [&](double own_px2, std::size_t count) {
    return judge(together(known, of_one_cause(2000.0, own_px2, times(count, 60.0)))).back();
  };
  EXPECT_EQ(back(0.5, 3), Outcome::kMatched) << "where one says exactly where the others are";
  EXPECT_EQ(back(30.0, 3), Outcome::kUnusable) << "where it leaves much room for them";
  EXPECT_EQ(back(30.0, 6), Outcome::kMatched) << "but six";
}

TEST(Consensus, WhoComesBackElsewhereThanTheOthersIsGated) {
  std::vector<Eigen::Vector2d> nu = times(6, 60.0);
  nu.emplace_back(-60.0, 0.0);
  const auto outcomes = judge(together(of_one_cause(0.5, 0.5, times(4, 0.5)), of_one_cause(2000.0, 0.5, nu)));
  std::vector<Outcome> expected(10, Outcome::kMatched);
  expected.push_back(Outcome::kGated);
  EXPECT_EQ(outcomes, expected);
}

TEST(Consensus, RescuesWhatFitsWhereItsPlaceIsKnown) {
  const Consensus consensus(32, kObservationGate, kImage_px2);
  EXPECT_TRUE(consensus.rescues(18.0, 10.0 * Eigen::Matrix2d::Identity()));
  EXPECT_FALSE(consensus.rescues(19.0, 10.0 * Eigen::Matrix2d::Identity()));
  EXPECT_FALSE(consensus.rescues(1.0, 20.0 * Eigen::Matrix2d::Identity()))
      << "in a wide ellipse anything fits";
}

TEST(Consensus, AllocatesNothingOnceItIsMade) {
  Consensus consensus(32, kObservationGate, kImage_px2);
  const Observations many =
      together(of_one_cause(0.5, 0.5, times(12, 0.5)), of_one_cause(2000.0, 30.0, times(20, 60.0)));
  const test::AllocationCount count;
  static_cast<void>(consensus.judge(many.S, many.nu));
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::ekf
