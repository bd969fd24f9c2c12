#include "workbench/eval/evaluate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eval/eval_support.hpp"

namespace waymark::eval {
namespace {

using test::moved;
using test::truth_at;
using test::wavy_path;

const std::vector<TrueLandmark> kTwoMarkers{{{LandmarkId::Family::kMarker, 1}, 0, 0, 0},
                                            {{LandmarkId::Family::kMarker, 2}, 5, 0, 0},
                                            {{LandmarkId::Family::kMarker, 3}, 0, 5, 0}};

std::vector<LandmarkEstimate> map_in(const Pose2& T_map_truth) {
  std::vector<LandmarkEstimate> map;
  for (const TrueLandmark& landmark : kTwoMarkers) {
    const Eigen::Vector2d p = T_map_truth * Eigen::Vector2d(landmark.x_m, landmark.y_m);
    map.push_back({.id = landmark.id, .position_m = {p.x(), p.y(), 0.0}});
  }
  return map;
}

TEST(Evaluate, APerfectRunInAnyFrameHasNoError) {
  const Trajectory path = wavy_path(500);
  const Pose2 T_estimate_truth{3, -2, 2.5};
  Trajectory estimate = moved(T_estimate_truth, path);
  for (TrajectoryPoint& point : estimate) point.covariance = Eigen::Matrix3d::Identity();
  const auto evaluation = evaluate(estimate, map_in(T_estimate_truth), TruthTrack::from_trajectory(path),
                                   kTwoMarkers, moved({1, 1, 1}, path));
  EXPECT_EQ(evaluation.pairs, 500u);
  EXPECT_NEAR(evaluation.scored_s, 49.9, 1e-9);
  EXPECT_NEAR(*evaluation.path_m, 49.9, 1e-6);
  EXPECT_NEAR(*evaluation.path.position_rmse_m, 0.0, 1e-9);
  EXPECT_NEAR(*evaluation.path.position_rmse_aligned_m, 0.0, 1e-9);
  EXPECT_NEAR(*evaluation.path.heading_rmse_deg, 0.0, 1e-9);
  EXPECT_NEAR(*evaluation.path.final_error_m, 0.0, 1e-9);
  EXPECT_NEAR(*evaluation.odometry.position_rmse_m, 0.0, 1e-9);
  EXPECT_NEAR(*evaluation.map->rmse_m, 0.0, 1e-9);
  EXPECT_NEAR(*evaluation.map->rmse_self_m, 0.0, 1e-9);
  EXPECT_NEAR(*evaluation.nees.mean, 0.0, 1e-9);
  EXPECT_EQ(evaluation.relative.size(), 4u);
  EXPECT_EQ(evaluation.series.size(), 500u);
  EXPECT_TRUE(evaluation.notes.empty());
}

TEST(Evaluate, DoesNotDependOnTheFrameOfTheEstimate) {
  RandomStream random = test::random_stream(21);
  const Trajectory path = wavy_path(300);
  Trajectory estimate = path;
  for (TrajectoryPoint& point : estimate)
    point.pose = point.pose * Pose2{0.1 * random.normal(), 0.1 * random.normal(), 0.05};
  const TruthTrack truth = TruthTrack::from_trajectory(path);
  const PathScore here = score_path(estimate, truth);
  const PathScore there = score_path(moved({100, -50, 3}, estimate), truth);
  EXPECT_GT(*here.position_rmse_m, *here.position_rmse_aligned_m);
  EXPECT_NEAR(*here.position_rmse_m, *there.position_rmse_m, 1e-9);
  EXPECT_NEAR(*here.position_rmse_aligned_m, *there.position_rmse_aligned_m, 1e-9);
  EXPECT_NEAR(*here.heading_rmse_deg, *there.heading_rmse_deg, 1e-9);
  EXPECT_NEAR(*here.final_error_m, *there.final_error_m, 1e-9);
}

TEST(Evaluate, ScoresSparseTruthAtItsOwnStamps) {
  const Trajectory path = test::straight_path(100, 0.1);
  const TruthTrack truth({truth_at(0, 0, 0), truth_at(4, 4, 0), truth_at(9, 9, 0.3)});
  const auto evaluation = evaluate(path, {}, truth, {});
  EXPECT_EQ(evaluation.pairs, 3u);
  EXPECT_NEAR(*evaluation.path.final_error_m, 0.3, 1e-9);
  EXPECT_NEAR(*evaluation.path.position_rmse_m, 0.3 / std::sqrt(3.0), 1e-9);
  EXPECT_FALSE(evaluation.path.heading_rmse_deg);
  EXPECT_TRUE(evaluation.relative.empty());
  EXPECT_FALSE(evaluation.nees.mean);
  EXPECT_THAT(evaluation.notes, testing::Contains(testing::HasSubstr("direction of the first metre")));
}

TEST(Evaluate, ScoresOnlyThePartThatTruthCovers) {
  const Trajectory path = wavy_path(200);
  Trajectory estimate = path;
  for (std::size_t i = 100; i < estimate.size(); ++i) estimate[i].pose.x_m += 100.0;
  const Trajectory first_half(path.begin(), path.begin() + 90);
  const auto evaluation = evaluate(estimate, {}, TruthTrack::from_trajectory(first_half), {});
  EXPECT_EQ(evaluation.pairs, 90u);
  EXPECT_NEAR(evaluation.scored_s, 8.9, 1e-9);
  EXPECT_NEAR(*evaluation.path.position_rmse_m, 0.0, 1e-9);
}

TEST(Evaluate, SaysHowMuchOfTheTruthLiesOutsideTheRun) {
  const auto evaluation = evaluate(wavy_path(50, 5.0), {}, TruthTrack::from_trajectory(wavy_path(100)), {});
  EXPECT_EQ(evaluation.truth_samples, 100u);
  EXPECT_EQ(evaluation.pairs, 50u);
  EXPECT_THAT(evaluation.notes, testing::ElementsAre(testing::HasSubstr("50 of 100 ground-truth samples")));
}

TEST(Evaluate, ComparesTheTruthSensorNotTheRobot) {
  const Trajectory path = wavy_path(200);
  const Eigen::Vector2d sensor_m(3.9, 0.65);
  std::vector<TruthSample> samples;
  for (const TrajectoryPoint& point : path) {
    const Eigen::Vector2d p = point.pose * sensor_m;
    samples.push_back({point.stamp, {p.x(), p.y(), point.pose.theta_rad}});
  }
  const TruthTrack truth(samples);
  EXPECT_NEAR(*score_path(path, truth, {.truth_sensor_m = sensor_m}).position_rmse_m, 0.0, 1e-9);
  EXPECT_GT(*score_path(path, truth).position_rmse_m, 0.5);
}

TEST(Evaluate, TheMapOfAStandingRobotIsNotTurnedByTheNoiseOfItsPath) {
  RandomStream random = test::random_stream(22);
  Trajectory estimate, path;
  for (int i = 0; i < 60; ++i) {
    const Stamp stamp = stamp_from_seconds(0.1 * i);
    path.push_back({stamp, {1e-4 * random.normal(), 1e-4 * random.normal(), 0.0}, std::nullopt});
    estimate.push_back({stamp, {1e-5 * random.normal(), 1e-5 * random.normal(), 0.0}, std::nullopt});
  }
  const auto evaluation =
      evaluate(estimate, map_in({}), TruthTrack::from_trajectory(path), kTwoMarkers, {}, {});
  EXPECT_LT(*evaluation.map->rmse_m, 0.001);
  EXPECT_THAT(evaluation.notes, testing::Contains(testing::HasSubstr("placed by the start pose")));
}

TEST(Evaluate, EmptyInputsLeaveEverythingEmpty) {
  const auto nothing = evaluate({}, {}, TruthTrack(), {});
  EXPECT_EQ(nothing.pairs, 0u);
  EXPECT_FALSE(nothing.path.position_rmse_m);
  EXPECT_FALSE(nothing.path_m);
  EXPECT_FALSE(nothing.map);
  EXPECT_FALSE(nothing.anchor);
  EXPECT_TRUE(nothing.notes.empty());

  const auto no_overlap = evaluate(wavy_path(10), map_in({}), TruthTrack({truth_at(99, 0, 0)}), kTwoMarkers);
  EXPECT_FALSE(no_overlap.path.position_rmse_m);
  EXPECT_TRUE(no_overlap.map->rmse_self_m) << "the map can still be compared by itself";
  EXPECT_FALSE(no_overlap.map->rmse_m);
  EXPECT_THAT(no_overlap.notes,
              testing::ElementsAre(testing::HasSubstr("no ground-truth sample lies within")));
}

TEST(Evaluate, OneTruthSampleIsEnoughToNotCrash) {
  const auto evaluation = evaluate(wavy_path(10), {}, TruthTrack({truth_at(0.5, 7, 7, 0.1)}), {});
  EXPECT_EQ(evaluation.pairs, 1u);
  EXPECT_NEAR(*evaluation.path.position_rmse_m, 0.0, 1e-12);
  EXPECT_FALSE(evaluation.path.position_rmse_aligned_m);
  EXPECT_EQ(*evaluation.path_m, 0.0);
}

}  // namespace
}  // namespace waymark::eval
