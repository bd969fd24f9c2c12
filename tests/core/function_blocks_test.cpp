#include "waymark/core/function_blocks.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

/// Computes until this thread has used `amount` of CPU time.
void compute_for(Duration amount) {
  for (const Duration end = thread_cpu_time() + amount; thread_cpu_time() < end;) continue;
}

TEST(FunctionBlocks, StartAtZeroInTheGivenOrder) {
  const FunctionBlocks blocks{"predict", "match", "update"};
  ASSERT_EQ(blocks.rows().size(), 3U);
  EXPECT_EQ(blocks.rows()[0].name, "predict");
  EXPECT_EQ(blocks.rows()[2].name, "update");
  for (const auto& row : blocks.rows()) {
    EXPECT_EQ(row.calls, 0);
    EXPECT_EQ(row.total, Duration{0});
  }
}

TEST(FunctionBlocks, AddUpCallsAndTime) {
  FunctionBlocks blocks{"a", "b"};
  blocks.record(1, Duration{20});
  blocks.record(1, Duration{22});
  EXPECT_EQ(blocks.rows()[0].calls, 0);
  EXPECT_EQ(blocks.rows()[1].calls, 2);
  EXPECT_EQ(blocks.rows()[1].total, Duration{42});
}

TEST(BlockTimer, GivesEveryBlockTheTimeSinceTheLastBorder) {
  FunctionBlocks blocks{"long", "short"};
  const Duration start = thread_cpu_time();
  BlockTimer timer(blocks);
  compute_for(std::chrono::milliseconds{5});
  timer.finish(0);
  compute_for(std::chrono::milliseconds{1});
  timer.finish(1);
  const Duration spent = thread_cpu_time() - start;
  EXPECT_GE(blocks.rows()[0].total, std::chrono::milliseconds{5});
  EXPECT_GE(blocks.rows()[1].total, std::chrono::milliseconds{1});
  EXPECT_LE(blocks.rows()[0].total + blocks.rows()[1].total, spent);
}

}  // namespace
}  // namespace waymark
