#include "workbench/report/rounded.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(Rounded, KeepsSixDigitsOfAnySize) {
  EXPECT_DOUBLE_EQ(rounded(0.0123456789), 0.0123457);
  EXPECT_DOUBLE_EQ(rounded(-98765.4321), -98765.4);
  EXPECT_DOUBLE_EQ(rounded(1234567.8), 1234570.0);
  EXPECT_EQ(rounded(0.0), 0.0);
  EXPECT_EQ(rounded(5e-324), 0.0);
}

TEST(Rounded, IsTheNumberThatItsDigitsSpell) {
  EXPECT_EQ(rounded(123456789.0), 123457000.0);
  EXPECT_EQ(rounded(9.87654321e15), 9.87654e15);
  EXPECT_EQ(rounded(0.000123456789), 0.000123457);
}

TEST(Rounded, LeavesWhatIsNotFinite) {
  EXPECT_TRUE(std::isnan(rounded(std::nan(""))));
  EXPECT_EQ(rounded(-std::numeric_limits<double>::infinity()), -std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace waymark
