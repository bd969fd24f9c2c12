#include "workbench/eval/space_score.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eval/eval_support.hpp"
#include "eval/space_support.hpp"

namespace waymark::eval {
namespace {

using test::lifted;
using test::wavy_path;
using testing::Contains;
using testing::HasSubstr;

SpacePath moved(const Eigen::Isometry3d& T, SpacePath path) {
  for (SpacePose& pose : path) {
    pose.p_m = T * pose.p_m;
    pose.q = Eigen::Quaterniond(T.linear()) * pose.q;
  }
  return path;
}

Eigen::Isometry3d some_motion() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(2.0, Eigen::Vector3d(0.3, -0.5, 0.7).normalized()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(4.0, -7.0, 2.0);
  return T;
}

TEST(EvaluateInSpace, APerfectPathInAnyFrameHasNoError) {
  const SpacePath path = lifted(in_space(wavy_path(300)), 2.0);
  const Evaluation e = evaluate_in_space(moved(some_motion(), path), path);
  EXPECT_EQ(e.pairs, 300U);
  EXPECT_NEAR(*e.path.position_rmse_m, 0.0, 1e-9);
  EXPECT_NEAR(*e.path.position_rmse_aligned_m, 0.0, 1e-9);
  EXPECT_NEAR(*e.path.heading_rmse_deg, 0.0, 1e-6);
  EXPECT_NEAR(*e.path.final_error_m, 0.0, 1e-9);
  EXPECT_THAT(e.notes, testing::ElementsAre(HasSubstr("the result is not planar")));
}

TEST(EvaluateInSpace, CountsErrorsAcrossThePlane) {
  const SpacePath truth = in_space(wavy_path(300));
  const Evaluation e = evaluate_in_space(lifted(truth, 2.0), truth);
  // z errs by 1 - cos, whose square has the mean 3 / 2, and whose aligned part is the mean of cos squared.
  EXPECT_NEAR(*e.path.position_rmse_m, std::sqrt(1.5), 0.05);
  EXPECT_GT(*e.path.position_rmse_aligned_m, 0.4);
  EXPECT_LT(*e.path.position_rmse_aligned_m, *e.path.position_rmse_m);
}

TEST(EvaluateInSpace, CountsTilt) {
  const SpacePath truth = in_space(wavy_path(100));
  SpacePath tilted = truth;
  for (std::size_t i = 1; i < tilted.size(); ++i)
    tilted[i].q = tilted[i].q * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX());
  const Evaluation e = evaluate_in_space(tilted, truth);
  EXPECT_NEAR(*e.path.heading_rmse_deg, to_degrees(0.2), 0.1);
  EXPECT_THAT(e.notes, Contains(HasSubstr("tilts by up to 11.5 deg")));
}

TEST(EvaluateInSpace, InterpolatesToTheStampsOfTheTruthAndNotOverHoles) {
  const SpacePath whole = lifted(in_space(wavy_path(100)), 2.0);
  SpacePath sparse;
  for (std::size_t i = 0; i < whole.size(); i += 5) sparse.push_back(whole[i]);
  const Evaluation e = evaluate_in_space(sparse, whole);
  EXPECT_EQ(e.pairs, 96U);
  EXPECT_LT(*e.path.position_rmse_m, 0.05);
  EXPECT_EQ(evaluate_in_space(sparse, whole, {.max_gap = std::chrono::milliseconds(100)}).pairs, 20U);
  EXPECT_THAT(e.notes, Contains(HasSubstr("96 of 100 ground-truth samples")));
}

TEST(EvaluateInSpace, AlignsTheStartByTheWholeWithoutOrientations) {
  const SpacePath truth = lifted(in_space(wavy_path(300)), 2.0);
  SpacePath estimate = moved(some_motion(), truth);
  for (SpacePose& pose : estimate) pose.q = Eigen::Quaterniond::Identity();
  const Evaluation e = evaluate_in_space(estimate, truth);
  EXPECT_NEAR(*e.path.position_rmse_m, 0.0, 1e-9);
  EXPECT_FALSE(e.path.heading_rmse_deg);
  EXPECT_THAT(e.notes, Contains(HasSubstr("same orientation")));
}

TEST(EvaluateInSpace, NothingInCommonIsNoScore) {
  const SpacePath path = in_space(wavy_path(10));
  const Evaluation e = evaluate_in_space(path, in_space(wavy_path(10, 100.0)));
  EXPECT_EQ(e.pairs, 0U);
  EXPECT_FALSE(e.path.position_rmse_m);
}

}  // namespace
}  // namespace waymark::eval
