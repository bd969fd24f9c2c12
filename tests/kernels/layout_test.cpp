#include "waymark/kernels/layout.hpp"

#include <gtest/gtest.h>

namespace waymark::kernels {
namespace {

TEST(Layout, RoundsToWholeBlocks) {
  EXPECT_EQ(round_up(0), 0U);
  EXPECT_EQ(round_up(1), 8U);
  EXPECT_EQ(round_up(16), 16U);
  EXPECT_EQ(round_down(15), 8U);
}

TEST(Layout, StrideIsAnOddNumberOfCacheLinesThatHoldsTheRow) {
  for (std::size_t n = 1; n < 500; ++n) {
    const std::size_t ld = padded_stride(n);
    EXPECT_GE(ld, n);
    EXPECT_LT(ld, n + 2 * kBlock);
    EXPECT_EQ(ld % (2 * kBlock), kBlock);
  }
}

}  // namespace
}  // namespace waymark::kernels
