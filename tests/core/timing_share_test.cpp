#include "waymark/core/timing_share.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace waymark {
namespace {

/// What `runs` runs come to, of which run i takes time_of(i): how many are timed, and what these stand for.
struct Count {
  int timed = 0;
  Duration stands_for{0};
};

template <class TimeOf>
Count count_timed(int runs, const TimeOf& time_of) {
  TimingShare share;
  Count count;
  for (int i = 0; i < runs; ++i) {
    if (!share.take()) continue;
    ++count.timed;
    count.stands_for += share.weight() * time_of(i);
    share.took(time_of(i), 2);
  }
  return count;
}

TEST(TimingShare, TakesTheFirstRun) {
  TimingShare share;
  EXPECT_TRUE(share.take());
  EXPECT_EQ(share.weight(), 1);
}

TEST(TimingShare, TakesAllLongRuns) {
  const auto time_of = [](int) { return std::chrono::milliseconds{1}; };
  const Count count = count_timed(1000, time_of);
  EXPECT_EQ(count.timed, 1000);
  EXPECT_EQ(count.stands_for, std::chrono::seconds{1});
}

TEST(TimingShare, ReadsClocksForHalfAPercentOfShortRuns) {
  const Duration run{1000};
  const Count count = count_timed(100'000, [=](int) { return run; });
  const double clocks_ns = 2 * 50.0 * count.timed;
  EXPECT_NEAR(clocks_ns / (100'000.0 * 1000.0), 0.005, 0.0005);
  EXPECT_NEAR(to_seconds(count.stands_for), 0.1, 0.001);
}

TEST(TimingShare, MeetsWhatAlternatesFairly) {
  const Count count = count_timed(200'000, [](int i) { return Duration{i % 2 == 0 ? 2000 : 10'000}; });
  EXPECT_NEAR(to_seconds(count.stands_for), 200'000 * 6e-6, 0.05 * 200'000 * 6e-6);
}

}  // namespace
}  // namespace waymark
