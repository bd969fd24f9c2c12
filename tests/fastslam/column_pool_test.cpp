#include "waymark/fastslam/column_pool.hpp"

#include <set>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"

namespace waymark::fastslam {
namespace {

TEST(ColumnPool, ColumnsAreApartAndAligned) {
  constexpr std::size_t kParticles = 100;
  ColumnPool pool(kParticles);
  std::set<std::uintptr_t> begins;
  for (int k = 0; k < 2000; ++k) begins.insert(reinterpret_cast<std::uintptr_t>(pool.take()));
  ASSERT_EQ(begins.size(), 2000U);
  std::uintptr_t end = 0;
  for (const std::uintptr_t begin : begins) {
    EXPECT_EQ(begin % 64, 0U);
    EXPECT_GE(begin, end);
    end = begin + 112 * sizeof(float);  // 100 particles in whole vectors of 16
  }
}

TEST(ColumnPool, TakesNoMemoryForColumnsThatWereGivenBack) {
  ColumnPool pool(1000);
  pool.reserve(10);
  const test::AllocationCount count;
  for (int round = 0; round < 1000; ++round) {
    float* const a = pool.take();
    float* const b = pool.take();
    EXPECT_NE(a, b);
    pool.give_back(a);
    pool.give_back(b);
  }
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::fastslam
