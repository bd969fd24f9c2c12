#include "workbench/study/scored_run.hpp"

#include <gtest/gtest.h>

#include "study_support.hpp"

namespace waymark::study {
namespace {

const UserSettings kUser = test::quick_plan({}).user;

TEST(ScoredRun, HoldsWhatRanAndHowItIsScored) {
  const auto run = run_and_score("sim:square", kUser);
  ASSERT_TRUE(run.ok()) << run.error().message;
  EXPECT_EQ(run->input, "sim:square");
  EXPECT_EQ(run->log.landmarks.size(), 8U);
  EXPECT_FALSE(run->recording.trajectory.empty());
  ASSERT_TRUE(run->evaluation.has_value());
  EXPECT_LT(*run->evaluation->path.position_rmse_m, *run->evaluation->odometry.position_rmse_m);
}

TEST(ScoredRun, InputThatCannotBeOpenedIsAnError) { EXPECT_FALSE(run_and_score("nowhere", kUser).ok()); }

TEST(ScoredRun, CanBeStopped) {
  const auto run = run_and_score("sim:square", kUser, {}, [](double progress) { return progress < 0.5; });
  ASSERT_TRUE(run.ok());
  EXPECT_TRUE(run->recording.error.has_value());
  EXPECT_FALSE(run->recording.trajectory.empty());
}

}  // namespace
}  // namespace waymark::study
