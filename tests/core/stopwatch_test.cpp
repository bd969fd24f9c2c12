#include "waymark/core/stopwatch.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

namespace waymark {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

void compute_for(Duration amount) {
  for (const Duration end = thread_cpu_time() + amount; thread_cpu_time() < end;) continue;
}

TEST(Stopwatch, CountsWhatTheThreadComputes) {
  Stopwatch stopwatch;
  const Duration before = thread_cpu_time();
  stopwatch.start();
  compute_for(milliseconds{5});
  const Duration took = stopwatch.stop();
  EXPECT_GE(took, milliseconds{5} - microseconds{10});
  EXPECT_LE(took, thread_cpu_time() - before + microseconds{10});
}

TEST(Stopwatch, LeavesOutWhatTheThreadDidNotRun) {
  Stopwatch stopwatch;
  const Duration before = thread_cpu_time();
  stopwatch.start();
  compute_for(milliseconds{1});
  std::this_thread::sleep_for(milliseconds{50});
  const Duration took = stopwatch.stop();
  EXPECT_GE(took, milliseconds{1} - microseconds{10});
  EXPECT_LE(took, thread_cpu_time() - before + microseconds{10});
}

TEST(Stopwatch, LeavesOutAPauseAmongManyShortSpans) {
  Stopwatch stopwatch;
  Duration longest{0};
  for (int i = 0; i < 200; ++i) {
    stopwatch.start();
    if (i == 100) std::this_thread::sleep_for(milliseconds{20});
    longest = std::max(longest, stopwatch.stop());
  }
  EXPECT_LT(longest, milliseconds{10});
}

TEST(Stopwatch, TakesNoPauseBetweenSpansOffALongSpan) {
  Stopwatch stopwatch;
  stopwatch.start();
  static_cast<void>(stopwatch.stop());
  std::this_thread::sleep_for(milliseconds{20});
  stopwatch.start();
  compute_for(milliseconds{2});
  EXPECT_GE(stopwatch.stop(), milliseconds{2} - microseconds{10});
}

}  // namespace
}  // namespace waymark
