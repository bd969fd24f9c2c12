#include "workbench/eval/align.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "eval/eval_support.hpp"

namespace waymark::eval {
namespace {

using test::moved;
using test::random_points;
using test::random_pose;
using test::random_stream;

void expect_same(const Pose2& a, const Pose2& b, double tolerance) {
  EXPECT_LT(difference(a, b).norm(), tolerance) << a.x_m << ' ' << a.y_m << ' ' << a.theta_rad;
}

double sum_of_squares(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return sum;
}

TEST(AlignRigid, RecoversRandomMotionsExactly) {
  RandomStream random = random_stream(3);
  for (int i = 0; i < 100; ++i) {
    const auto from = random_points(random, 2 + i % 7);
    const Pose2 T = random_pose(random, 1000.0);
    expect_same(*align_rigid(from, moved(T, from)), T, 1e-9);
  }
}

TEST(AlignRigid, IsTheLeastSquaresMotion) {
  RandomStream random = random_stream(4);
  const auto from = random_points(random, 20);
  const auto to = random_points(random, 20);
  const Pose2 T = *align_rigid(from, to);
  const double best = sum_of_squares(moved(T, from), to);
  for (int i = 0; i < 50; ++i) {
    const Pose2 nudged{T.x_m + 1e-3 * random.normal(), T.y_m + 1e-3 * random.normal(),
                       T.theta_rad + 1e-3 * random.normal()};
    EXPECT_GE(sum_of_squares(moved(nudged, from), to), best);
  }
}

TEST(AlignRigid, DegenerateInputs) {
  EXPECT_FALSE(align_rigid({}, {}));
  const std::vector<Eigen::Vector2d> one{{1.0, 2.0}};
  const std::vector<Eigen::Vector2d> two{{1.0, 2.0}, {3.0, 4.0}};
  EXPECT_FALSE(align_rigid(one, two));
  expect_same(*align_rigid(one, std::vector<Eigen::Vector2d>{{4.0, 6.0}}), {3.0, 4.0, 0.0}, 1e-12);
}

TEST(AlignRigidRobust, IgnoresWrongMatches) {
  RandomStream random = random_stream(5);
  for (int i = 0; i < 20; ++i) {
    const auto from = random_points(random, 15);
    const Pose2 T = random_pose(random);
    auto to = moved(T, from);
    for (auto& p : to) p += 0.01 * Eigen::Vector2d(random.normal(), random.normal());
    for (std::size_t k = 0; k < 6; ++k) to[k] = {random.uniform(-20, 20), random.uniform(-20, 20)};
    const Pose2 found = *align_rigid_robust(from, to);
    EXPECT_LT(difference(found, T).head<2>().norm(), 0.05);
    EXPECT_LT(std::abs(difference(found, T).z()), 0.01);
  }
}

TEST(AlignRigidRobust, HandlesManyPointsAndExactOnes) {
  RandomStream random = random_stream(6);
  const auto from = random_points(random, 800);
  const Pose2 T = random_pose(random);
  expect_same(*align_rigid_robust(from, moved(T, from)), T, 1e-9);
  EXPECT_FALSE(align_rigid_robust(std::span(from).first(2), std::span(from).first(2)));
}

TEST(AlignSimilarity, RecoversRandomSimilaritiesAndIsTheLeastSquaresOne) {
  RandomStream random = test::random_stream(11);
  for (int i = 0; i < 20; ++i) {
    const Similarity truth{random.uniform(0.2, 3.0), test::random_pose(random)};
    const auto from = test::random_points(random, 8);
    std::vector<Eigen::Vector2d> to;
    for (const auto& p : from) to.push_back(truth * p);
    const auto found = align_similarity(from, to);
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(found->scale, truth.scale, 1e-12);
    for (std::size_t k = 0; k < from.size(); ++k) EXPECT_LT((*found * from[k] - to[k]).norm(), 1e-11);
  }
  const auto from = test::random_points(random, 8);
  const auto to = test::random_points(random, 8);
  const auto cost = [&](const Similarity& s) {
    double sum = 0.0;
    for (std::size_t k = 0; k < from.size(); ++k) sum += (s * from[k] - to[k]).squaredNorm();
    return sum;
  };
  const Similarity best = *align_similarity(from, to);
  for (const double step : {-1e-3, 1e-3}) {
    EXPECT_LT(cost(best), cost({best.scale + step, best.motion}));
    EXPECT_LT(cost(best),
              cost({best.scale, {best.motion.x_m + step, best.motion.y_m, best.motion.theta_rad}}));
    EXPECT_LT(cost(best),
              cost({best.scale, {best.motion.x_m, best.motion.y_m, best.motion.theta_rad + step}}));
  }
}

TEST(FittedScale, FindsTheScaleWhateverTheMotion) {
  RandomStream random = random_stream(7);
  const auto from = random_points(random, 30);
  auto to = moved(random_pose(random), from);
  for (auto& p : to) p *= 0.93;
  EXPECT_NEAR(*fitted_scale(from, to), 0.93, 1e-12);
  EXPECT_FALSE(fitted_scale(std::vector<Eigen::Vector2d>(3, {1, 1}), std::span(to).first(3)));
}

}  // namespace
}  // namespace waymark::eval
