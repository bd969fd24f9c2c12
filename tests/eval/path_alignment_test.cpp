#include "workbench/eval/path_alignment.hpp"

#include <gtest/gtest.h>

#include "eval/eval_support.hpp"

namespace waymark::eval {
namespace {

using test::moved;
using test::random_pose;
using test::random_stream;
using test::wavy_path;

/// The truth of `path`, without headings if so wished.
TruthTrack truth_of(const Trajectory& path, bool with_heading = true) {
  std::vector<TruthSample> samples = TruthTrack::from_trajectory(path).samples();
  if (!with_heading) {
    for (TruthSample& sample : samples) sample.truth.theta_rad.reset();
  }
  return TruthTrack(samples);
}

TEST(StartAlignment, UndoesAnyFrameByTheFirstHeading) {
  RandomStream random = random_stream(8);
  for (int i = 0; i < 20; ++i) {
    const Trajectory path = moved(random_pose(random), wavy_path(50));
    const Pose2 T = random_pose(random);
    const auto anchor = anchor_at_start(associate(moved(T.inverse(), path), truth_of(path)));
    ASSERT_TRUE(anchor);
    EXPECT_EQ(anchor->heading, AnchorHeading::kTruth);
    EXPECT_LT(difference(anchor->T_truth_estimate, T).norm(), 1e-9);
  }
}

TEST(StartAlignment, RestsOnTheFirstMetreWithoutHeading) {
  RandomStream random = random_stream(9);
  const Trajectory path = wavy_path(50);
  const Pose2 T = random_pose(random);
  const auto anchor = anchor_at_start(associate(moved(T.inverse(), path), truth_of(path, false)));
  ASSERT_TRUE(anchor);
  EXPECT_EQ(anchor->heading, AnchorHeading::kPath);
  EXPECT_LT(difference(anchor->T_truth_estimate, T).norm(), 1e-9);
}

TEST(StartAlignment, TakesFramesAsParallelWhenNothingElseIsKnown) {
  const Trajectory path = wavy_path(5);
  const auto anchor = anchor_at_start(associate(moved({3.0, 4.0, 0.0}, path), truth_of(path, false)));
  ASSERT_TRUE(anchor);
  EXPECT_EQ(anchor->heading, AnchorHeading::kNone);
  EXPECT_LT(difference(anchor->T_truth_estimate, {-3.0, -4.0, 0.0}).norm(), 1e-12);
  EXPECT_FALSE(anchor_at_start({}));
}

TEST(FitPath, RecoversTheFrameAndTheScale) {
  RandomStream random = random_stream(10);
  const Trajectory path = wavy_path(200);
  const Pose2 T = random_pose(random);
  const auto fit = fit_path(associate(moved(T.inverse(), path), truth_of(path)));
  ASSERT_TRUE(fit);
  EXPECT_LT(difference(fit->T_truth_estimate, T).norm(), 1e-9);
  EXPECT_NEAR(*fit->scale, 1.0, 1e-12);
}

TEST(FitPath, SaysNothingOfTwoPairs) {
  EXPECT_FALSE(fit_path(associate(wavy_path(2), truth_of(wavy_path(2)))));
}

}  // namespace
}  // namespace waymark::eval
