#include "waymark/core/function_blocks.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace waymark {
namespace {

void compute_for(Duration amount) {
  for (const Duration end = monotonic_time() + amount; monotonic_time() < end;) continue;
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
  const Duration start = monotonic_time();
  {
    BlockTimer timer(blocks, 0);
    compute_for(std::chrono::milliseconds{5});
    timer.finish(0);
    compute_for(std::chrono::milliseconds{1});
    timer.finish(1);
  }
  const Duration spent = monotonic_time() - start;
  EXPECT_GE(blocks.rows()[0].total, std::chrono::milliseconds{5});
  EXPECT_GE(blocks.rows()[1].total, std::chrono::milliseconds{1});
  EXPECT_LE(blocks.rows()[0].total + blocks.rows()[1].total, spent);
}

TEST(BlockTimer, LetsTimedCallsStandForThoseBetween) {
  constexpr int kCalls = 20'000;
  FunctionBlocks blocks{"short"};
  for (int i = 0; i < kCalls; ++i) {
    BlockTimer timer(blocks, 0);
    compute_for(Duration{500});
    timer.finish(0);
  }
  EXPECT_EQ(blocks.rows()[0].calls, kCalls);
  EXPECT_GE(blocks.rows()[0].total, (kCalls - 200) * Duration{500});
}

}  // namespace
}  // namespace waymark
