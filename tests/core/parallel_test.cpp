#include "waymark/core/parallel.hpp"

#include <atomic>
#include <cmath>
#include <new>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <gmock/gmock.h>

#include "support/no_more_threads.hpp"

namespace waymark {
namespace {

class ThreadPoolOf : public testing::TestWithParam<int> {};

TEST_P(ThreadPoolOf, RunsEveryBlockOnceWhateverTheirNumber) {
  ThreadPool thread_pool(GetParam());
  EXPECT_EQ(thread_pool.size(), GetParam());
  for (const int blocks : {0, 1, 2, 3, 7, 64, 1000}) {
    std::vector<int> runs(static_cast<std::size_t>(blocks), 0);
    thread_pool.run(blocks, [&](int block) { ++runs[static_cast<std::size_t>(block)]; });
    EXPECT_EQ(runs, std::vector<int>(static_cast<std::size_t>(blocks), 1)) << blocks;
  }
}

TEST_P(ThreadPoolOf, ServesTenThousandJobs) {
  ThreadPool thread_pool(GetParam());
  std::vector<int> runs(5, 0);
  for (int job = 0; job < 10000; ++job) {
    thread_pool.run(5, [&runs](int block) { ++runs[static_cast<std::size_t>(block)]; });
    ASSERT_EQ(runs, std::vector<int>(5, job + 1)) << "not all blocks were done when run() returned";
  }
}

TEST_P(ThreadPoolOf, GivesTheSameBitsForTheSameBlocks) {
  std::vector<double> sums(37);
  ThreadPool thread_pool(GetParam());
  thread_pool.run(37, [&](int block) {
    double sum = 0.0;
    for (int i = 1; i < 1000; ++i) sum += std::sin(block * 0.1 + i);
    sums[static_cast<std::size_t>(block)] = sum;
  });
  for (int block = 0; block < 37; ++block) {
    double sum = 0.0;
    for (int i = 1; i < 1000; ++i) sum += std::sin(block * 0.1 + i);
    EXPECT_EQ(sums[static_cast<std::size_t>(block)], sum);
  }
}

TEST_P(ThreadPoolOf, TakesAConstantJobAndOneWithState) {
  ThreadPool thread_pool(GetParam());
  std::atomic<int> total = 0;
  const auto constant = [&total](int block) { total += block; };
  thread_pool.run(10, constant);
  EXPECT_EQ(total, 45);
  struct Counter {
    std::atomic<int> calls = 0;
    void operator()(int) { ++calls; }
  } counter;
  thread_pool.run(10, counter);
  EXPECT_EQ(counter.calls, 10) << "the caller's own object is called, not a copy";
}

TEST_P(ThreadPoolOf, ThrowsWhatAJobThrowsAndServesOn) {
  ThreadPool thread_pool(GetParam());
  for (const int blocks : {1, 2, 64}) {
    std::atomic<int> ended = 0;
    const auto job = [&](int block) {
      if (block == blocks / 2) throw std::runtime_error("block " + std::to_string(block));
      ++ended;
    };
    try {
      thread_pool.run(blocks, job);
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& problem) {
      EXPECT_EQ(problem.what(), "block " + std::to_string(blocks / 2));
    }
    EXPECT_LT(ended, blocks);
    ended = 0;
    thread_pool.run(blocks, [&](int) { ++ended; });
    EXPECT_EQ(ended, blocks) << "the team is of no more use";
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, ThreadPoolOf, testing::Values(1, 2, 3, 8));

TEST(ThreadPool, ThrowsOnceWhereAllBlocksThrow) {
  ThreadPool thread_pool(3);
  EXPECT_THROW(thread_pool.run(100, [](int) { throw std::bad_alloc(); }), std::bad_alloc);
  std::atomic<int> ended = 0;
  thread_pool.run(100, [&](int) { ++ended; });
  EXPECT_EQ(ended, 100);
}

TEST(ThreadPool, ThatCannotBeStartedSaysSo) {
  const test::NoMoreThreads none;
  EXPECT_EQ(ThreadPool(1).size(), 1);
  try {
    const ThreadPool thread_pool(256);
    FAIL() << "there can be no threads";
  } catch (const std::system_error& problem) {
    EXPECT_THAT(problem.what(), testing::StartsWith("could not start 255 threads: "));
  }
}

TEST(ThreadPool, UsesItsThreads) {
  // Two blocks that wait for each other can only end on two threads.
  ThreadPool thread_pool(2);
  std::atomic<int> arrived = 0;
  thread_pool.run(2, [&](int) {
    ++arrived;
    while (arrived < 2) std::this_thread::yield();
  });
  EXPECT_EQ(arrived, 2);
}

TEST(ThreadPool, OfOneRunsOnTheCallersThreadInOrder) {
  ThreadPool thread_pool(1);
  std::vector<int> order;
  thread_pool.run(5, [&](int block) { order.push_back(block); });
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(ThreadPool, EndsWithoutEverHavingWorked) {
  for (int i = 0; i < 100; ++i) EXPECT_EQ(ThreadPool(3).size(), 3);
}

}  // namespace
}  // namespace waymark
