#include "waymark/core/clocks.hpp"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(Clocks, BothGoOnWhileAThreadComputes) {
  const Duration elapsed = monotonic_time();
  const Duration cpu = thread_cpu_time();
  while (thread_cpu_time() - cpu < std::chrono::milliseconds{2}) continue;
  EXPECT_GE(monotonic_time() - elapsed, std::chrono::milliseconds{2});
}

TEST(Clocks, OnlyTheMonotonicOneGoesOnWhileAThreadSleeps) {
  const Duration elapsed = monotonic_time();
  const Duration cpu = thread_cpu_time();
  std::this_thread::sleep_for(std::chrono::milliseconds{30});
  EXPECT_LT(thread_cpu_time() - cpu, std::chrono::milliseconds{15});
  EXPECT_GE(monotonic_time() - elapsed, std::chrono::milliseconds{30});
}

}  // namespace
}  // namespace waymark
