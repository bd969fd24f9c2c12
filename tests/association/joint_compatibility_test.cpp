#include "waymark/association/joint_compatibility.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "waymark/core/angle.hpp"
#include "waymark/core/chi2.hpp"
#include "waymark/core/random.hpp"

namespace waymark {
namespace {

constexpr double kProbability = 0.999;
constexpr int kMost = 8;
constexpr int kNoLimit = 1 << 30;

/// Observations that share the error of a pose, against landmarks with errors of their own.
struct Scan {
  std::vector<JointPair> pairs;
  std::vector<Eigen::Matrix<double, 2, 6>> H;  // to a common error (3), and to a landmark's own (2), by pair
  Eigen::Matrix3d P_pose;
  int observations = 0;

  [[nodiscard]] Eigen::Matrix2d common(int a, int b) const {
    const auto& H_a = H[static_cast<std::size_t>(a)];
    const auto& H_b = H[static_cast<std::size_t>(b)];
    Eigen::Matrix2d sum = H_a.leftCols<3>() * P_pose * H_b.leftCols<3>().transpose();
    if (pairs[static_cast<std::size_t>(a)].landmark == pairs[static_cast<std::size_t>(b)].landmark)
      sum += 0.04 * H_a.block<2, 2>(0, 3) * H_b.block<2, 2>(0, 3).transpose();
    return sum;
  }
};

/// Landmarks and observations anywhere in a square, each seen or not, all moved by a common error.
Scan random_scan(std::uint64_t seed) {
  RandomStream random(seed, StreamPurpose::kSimulation);
  Scan scan;
  scan.P_pose = Eigen::Vector3d(0.3, 0.3, 0.01).asDiagonal();
  scan.observations = 5;
  const Eigen::Vector2d moved(0.5 * random.normal(), 0.5 * random.normal());
  std::vector<Eigen::Vector2d> landmarks;
  for (int k = 0; k < 5; ++k) landmarks.emplace_back(random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0));
  for (int i = 0; i < scan.observations; ++i) {
    const Eigen::Vector2d z = (i < 4 ? landmarks[static_cast<std::size_t>(i)] : Eigen::Vector2d(0.3, 0.1)) +
                              moved + 0.2 * Eigen::Vector2d(random.normal(), random.normal());
    for (int k = 0; k < 5; ++k) {
      const Eigen::Vector2d nu = z - landmarks[static_cast<std::size_t>(k)];
      if (nu.norm() > 2.0) continue;
      scan.pairs.push_back({i, k, nu, 0.04 * Eigen::Matrix2d::Identity(), random.uniform(0.0, 3.0)});
      Eigen::Matrix<double, 2, 6> H = Eigen::Matrix<double, 2, 6>::Zero();
      H.leftCols<2>().setIdentity();
      H.col(2) = Eigen::Vector2d(-z.y(), z.x());
      H.block<2, 2>(0, 3).setIdentity();
      scan.H.push_back(H);
    }
  }
  return scan;
}

JointCompatibility solved(const Scan& scan, int max_nodes = kNoLimit) {
  JointCompatibility match(kProbability, kMost, max_nodes);
  for (const JointPair& pair : scan.pairs) match.add(pair);
  match.solve(scan.observations, [&](int a, int b) { return scan.common(a, b); });
  return match;
}

/// By the plain formula; minus infinity where the pairs are not compatible.
double score_of(const Scan& scan, const std::vector<int>& chosen) {
  if (chosen.empty()) return 0.0;
  const auto n = static_cast<Eigen::Index>(2 * chosen.size());
  Eigen::MatrixXd S(n, n);
  Eigen::VectorXd nu(n);
  double score = 0.0;
  for (std::size_t a = 0; a < chosen.size(); ++a) {
    const JointPair& pair = scan.pairs[static_cast<std::size_t>(chosen[a])];
    const auto row = static_cast<Eigen::Index>(2 * a);
    nu.segment<2>(row) = pair.nu;
    score += pair.bonus;
    for (std::size_t b = 0; b < chosen.size(); ++b)
      S.block<2, 2>(row, static_cast<Eigen::Index>(2 * b)) = scan.common(chosen[a], chosen[b]);
    S.block<2, 2>(row, row) += pair.R;
  }
  const double d2 = nu.dot(S.llt().solve(nu));
  if (d2 > chi2_quantile(kProbability, static_cast<double>(n))) return -HUGE_VAL;
  return score - 0.5 * (d2 + std::log(S.determinant())) - static_cast<double>(n) / 2.0 * std::log(2.0 * kPi);
}

struct Best {
  double score = 0.0;
  std::vector<int> chosen;
};

/// All one-to-one pairings.
void try_all(const Scan& scan, std::size_t next, std::vector<int>& chosen, Best& best) {
  if (next == scan.pairs.size()) {
    const double score = score_of(scan, chosen);
    if (score > best.score) best = {score, chosen};
    return;
  }
  try_all(scan, next + 1, chosen, best);
  for (const int other : chosen) {
    const JointPair& taken = scan.pairs[static_cast<std::size_t>(other)];
    if (taken.observation == scan.pairs[next].observation || taken.landmark == scan.pairs[next].landmark)
      return;
  }
  chosen.push_back(static_cast<int>(next));
  try_all(scan, next + 1, chosen, best);
  chosen.pop_back();
}

TEST(JointCompatibility, IsTheBestOfAllPairings) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Scan scan = random_scan(seed);
    Best best;
    std::vector<int> chosen;
    try_all(scan, 0, chosen, best);
    const JointCompatibility match = solved(scan);
    EXPECT_NEAR(match.score(), best.score, 1e-9) << seed;
    std::vector<int> expected(static_cast<std::size_t>(scan.observations), JointCompatibility::kNothing);
    for (const int pair : best.chosen)
      expected[static_cast<std::size_t>(scan.pairs[static_cast<std::size_t>(pair)].observation)] = pair;
    for (int i = 0; i < scan.observations; ++i)
      EXPECT_EQ(match.pair_of(i), expected[static_cast<std::size_t>(i)]) << seed;
    EXPECT_TRUE(match.is_exhaustive());
  }
}

/// Two observations 1 m left of two landmarks 1 m apart. One by one the first is nearest to the wrong one.
TEST(JointCompatibility, TakesWhatFitsTogetherNotWhatIsNearest) {
  Scan scan;
  scan.P_pose = Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal();
  scan.observations = 2;
  const auto add = [&](int observation, int landmark, double apart_m) {
    scan.pairs.push_back({observation, landmark, {apart_m, 0.0}, 1e-4 * Eigen::Matrix2d::Identity(), 3.0});
    Eigen::Matrix<double, 2, 6> H = Eigen::Matrix<double, 2, 6>::Zero();
    H.leftCols<2>().setIdentity();
    scan.H.push_back(H);
  };
  add(0, 0, 0.9);
  add(0, 1, -0.1);
  add(1, 1, 0.9);
  const JointCompatibility match = solved(scan);
  EXPECT_EQ(match.landmark_of(0), 0);
  EXPECT_EQ(match.landmark_of(1), 1);
}

TEST(JointCompatibility, LessThanNothingKnownIsNotMatched) {
  Scan scan = random_scan(1);
  for (JointPair& pair : scan.pairs) pair.bonus = -50.0;
  const JointCompatibility match = solved(scan);
  for (int i = 0; i < scan.observations; ++i) EXPECT_EQ(match.landmark_of(i), JointCompatibility::kNothing);
}

TEST(JointCompatibility, StopsAtItsLimitWithOneToOneMatches) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scan scan = random_scan(seed);
    const JointCompatibility match = solved(scan, 4);
    std::vector<int> seen;
    for (int i = 0; i < scan.observations; ++i)
      if (match.landmark_of(i) != JointCompatibility::kNothing) seen.push_back(match.landmark_of(i));
    std::ranges::sort(seen);
    EXPECT_EQ(std::ranges::adjacent_find(seen), seen.end());
    EXPECT_LE(match.score(), solved(scan).score() + 1e-9);
  }
}

TEST(JointCompatibility, LeavesOutWhatIsNotANumber) {
  Scan scan = random_scan(2);
  const JointCompatibility clean = solved(scan);
  JointPair bad = scan.pairs.front();
  bad.nu[0] = std::numeric_limits<double>::quiet_NaN();
  scan.pairs.push_back(bad);
  scan.H.push_back(scan.H.front());
  EXPECT_EQ(solved(scan).score(), clean.score());
}

TEST(JointCompatibility, NothingIsMatchedWithNothing) {
  JointCompatibility match(kProbability, kMost, kNoLimit);
  match.solve(2, [](int, int) { return Eigen::Matrix2d(); });
  EXPECT_EQ(match.landmark_of(0), JointCompatibility::kNothing);
  EXPECT_EQ(match.score(), 0.0);
}

TEST(JointCompatibility, AllocatesOnlyAsScansGrow) {
  const Scan scan = random_scan(3);
  JointCompatibility match = solved(scan);
  const test::AllocationCount count;
  match.clear();
  for (const JointPair& pair : scan.pairs) match.add(pair);
  match.solve(scan.observations, [&](int a, int b) { return scan.common(a, b); });
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark
