#include "waymark/kernels/multiply_add.hpp"

#include <gtest/gtest.h>

namespace waymark::kernels {
namespace {

// x <- x/2 + 1/2 has the fixed point 1: after many rounds every lane of all twelve chains stands there.
TEST(MultiplyAdd, DoesTheWorkItCounts) {
  const MultiplyAdds done = multiply_add(200);
  const double lanes = done.flop / (2.0 * 200 * 12);
  EXPECT_GE(lanes, 1.0);
  EXPECT_DOUBLE_EQ(done.sum, 12.0 * lanes);
  EXPECT_DOUBLE_EQ(multiply_add(400).flop, 2.0 * done.flop);
}

}  // namespace
}  // namespace waymark::kernels
