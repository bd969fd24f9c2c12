#include "workbench/eval/procrustes.hpp"

#include <gtest/gtest.h>

#include "eval/eval_support.hpp"

namespace waymark::eval {
namespace {

std::vector<PosePair> pairs_of(const std::vector<Eigen::Vector2d>& estimates,
                               const std::vector<Eigen::Vector2d>& truths) {
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i < estimates.size(); ++i)
    pairs.push_back({.estimate = {estimates[i].x(), estimates[i].y(), 0.0},
                     .truth = {truths[i].x(), truths[i].y(), std::nullopt}});
  return pairs;
}

std::vector<Eigen::Vector2d> scaled(double factor, std::vector<Eigen::Vector2d> points) {
  for (auto& p : points) p *= factor;
  return points;
}

TEST(Procrustes, FreeScaleHidesABiasedSensorEntirely) {
  RandomStream random = test::random_stream(1);
  const Pose2 T_truth_estimate = test::random_pose(random);
  const auto landmarks = test::random_points(random, 6);
  const auto path = test::random_points(random, 20);
  const auto score = procrustes_score(pairs_of(scaled(1.07, path), test::moved(T_truth_estimate, path)),
                                      {scaled(1.07, landmarks), test::moved(T_truth_estimate, landmarks)});
  ASSERT_TRUE(score.has_value());
  EXPECT_NEAR(score->scale, 1.0 / 1.07, 1e-12);
  EXPECT_NEAR(score->landmark_rmse_m, 0.0, 1e-9);
  EXPECT_NEAR(*score->position_rmse_m, 0.0, 1e-9);
}

TEST(Procrustes, ATurnedMapSwingsAPerfectPath) {
  const std::vector<Eigen::Vector2d> surveyed{{9.0, 0.0}, {10.0, 0.0}, {11.0, 0.0}};
  const std::vector<Eigen::Vector2d> mapped{{9.0, -0.1}, {10.0, 0.0}, {11.0, 0.1}};
  const std::vector<Eigen::Vector2d> path{{0.0, 0.0}};
  const auto score = procrustes_score(pairs_of(path, path), {mapped, surveyed});
  ASSERT_TRUE(score.has_value());
  EXPECT_NEAR(score->landmark_rmse_m, 0.0, 0.01);
  EXPECT_GT(*score->position_rmse_m, 0.9) << "0.1 rad at 10 m";
}

TEST(Procrustes, NeedsThreeLandmarksAndNoPath) {
  const std::vector<Eigen::Vector2d> two{{0.0, 0.0}, {1.0, 0.0}};
  EXPECT_FALSE(procrustes_score({}, {two, two}).has_value());
  const std::vector<Eigen::Vector2d> three{{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
  const auto score = procrustes_score({}, {three, three});
  ASSERT_TRUE(score.has_value());
  EXPECT_FALSE(score->position_rmse_m.has_value());
  const std::vector<Eigen::Vector2d> one_place(3, Eigen::Vector2d(1.0, 1.0));
  EXPECT_FALSE(procrustes_score({}, {one_place, three}).has_value());
}

}  // namespace
}  // namespace waymark::eval
