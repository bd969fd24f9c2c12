#include "waymark/vision/frame_budget.hpp"

#include <gtest/gtest.h>

#include "waymark/core/function_blocks.hpp"

namespace waymark::vision {
namespace {

void spin(Duration span) {
  const Duration end = thread_cpu_time() + span;
  while (thread_cpu_time() < end) {
  }
}

TEST(FrameBudget, OfWorkIsUsedUpByWhatIsSpentAndByNothingElse) {
  FrameBudget budget(BudgetKind::kWork);
  budget.start(Duration{1000});
  spin(Duration{100'000});
  EXPECT_TRUE(budget.allows(1000.0));
  budget.spend(600.0);
  EXPECT_TRUE(budget.allows(400.0));
  EXPECT_FALSE(budget.allows(401.0));
  budget.start(Duration{1000});
  EXPECT_TRUE(budget.allows(1000.0));
}

TEST(FrameBudget, RemembersTheFirstThatItRefusedAndWhatIsLeft) {
  FrameBudget budget(BudgetKind::kWork);
  budget.start(Duration{1000});
  budget.spend(600.0);
  EXPECT_EQ(budget.left(), Duration{400});
  EXPECT_TRUE(budget.allows(400.0));
  EXPECT_EQ(budget.refused(), Duration{0});
  EXPECT_FALSE(budget.allows(500.0));
  EXPECT_FALSE(budget.allows(800.0));
  EXPECT_EQ(budget.refused(), Duration{500});
  budget.spend(600.0);
  EXPECT_EQ(budget.left(), Duration{0});
  budget.start(Duration{1000});
  EXPECT_EQ(budget.refused(), Duration{0});
}

TEST(FrameBudget, OfTheClockIsUsedUpByTime) {
  FrameBudget budget(BudgetKind::kClock);
  budget.start(std::chrono::milliseconds(20));
  EXPECT_TRUE(budget.allows(1.0));
  spin(std::chrono::milliseconds(21));
  EXPECT_FALSE(budget.allows(1.0));
}

TEST(FrameBudget, OfTheClockLearnsWhatACostTakesHere) {
  FrameBudget budget(BudgetKind::kClock);
  budget.start(std::chrono::seconds(10));
  spin(std::chrono::milliseconds(2));
  budget.spend(1000.0);  // so a cost of 1 takes 2 us at least
  budget.start(std::chrono::milliseconds(20));
  EXPECT_FALSE(budget.allows(10'001.0));
}

TEST(FrameBudget, OfNoTimeAllowsNothing) {
  for (const BudgetKind kind : {BudgetKind::kWork, BudgetKind::kClock}) {
    FrameBudget budget(kind);
    budget.start(Duration{-5});
    EXPECT_FALSE(budget.allows(0.0));
  }
}

TEST(WorkCosts, OfScalarCodeAreHigher) {
  const WorkCosts simd = work_costs(kernels::Instructions::kSimd),
                  scalar = work_costs(kernels::Instructions::kScalar);
  EXPECT_GT(scalar.window_ns, simd.window_ns);
  EXPECT_GT(scalar.pixel_ns, simd.pixel_ns);
}

}  // namespace
}  // namespace waymark::vision
