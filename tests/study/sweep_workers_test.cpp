#include "workbench/study/sweep_workers.hpp"

#include <system_error>

#include <gtest/gtest.h>

#include "support/io_support.hpp"
#include "support/no_more_threads.hpp"

#include "study_support.hpp"
#include "workbench/study/sweep_summary.hpp"

namespace waymark::study {
namespace {

using waymark::test::TempFolder;

SweepPlan workers_plan() {
  return test::quick_plan(
      {{"seed", {"1", "2", "3"}}, {"filter", {"ekf", "fastslam"}}, {"fastslam.particles", {"20"}}});
}

std::vector<SweepRow> rows_of(int threads) {
  const TempFolder folder;
  const auto sweep = Sweep::open(workers_plan(), folder.path()).value();
  { const SweepWorkers sweep_workers(*sweep, threads); }
  return sweep->rows();
}

// Times differ from run to run, all else is the same to the last bit.
TEST(SweepWorkers, MakesAllRunsAndTheResultDoesNotDependOnThreads) {
  const auto alone = rows_of(1);
  const auto together = rows_of(3);
  ASSERT_EQ(alone.size(), 6U);
  ASSERT_EQ(together.size(), 6U);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(alone[i].point, together[i].point);
    EXPECT_EQ(alone[i].error, "");
    for (const char* name : {"position_rmse_m", "landmark_rmse_m", "nees_median", "frobenius_mixture_m2"})
      EXPECT_EQ(alone[i].figures[figure_index(name)], together[i].figures[figure_index(name)]) << name;
  }
}

TEST(SweepWorkers, ThatCannotBeStartedStopsTheSweep) {
  const TempFolder folder;
  const auto sweep = Sweep::open(workers_plan(), folder.path()).value();
  const waymark::test::NoMoreThreads none;
  EXPECT_THROW(SweepWorkers(*sweep, 2), std::system_error);
  EXPECT_TRUE(sweep->stopped());
}

TEST(SweepWorkers, StoppedSweepEndsWithoutHalfARun) {
  const TempFolder folder;
  const auto sweep = Sweep::open(workers_plan(), folder.path()).value();
  sweep->stop();
  SweepWorkers sweep_workers(*sweep, 2);
  while (sweep_workers.busy()) std::this_thread::yield();
  EXPECT_EQ(sweep->done(), 0U);
}

}  // namespace
}  // namespace waymark::study
