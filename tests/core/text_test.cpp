#include "waymark/core/text.hpp"

#include <cstdint>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(Text, PutsStringsAndWholeNumbersOneAfterTheOther) {
  EXPECT_EQ(concat("of ", std::size_t{3}, std::string(" landmarks, "), -2, " "), "of 3 landmarks, -2 ");
  EXPECT_EQ(concat(std::numeric_limits<std::uint64_t>::max()), "18446744073709551615");
  EXPECT_EQ(concat(), "");
}

TEST(Text, DecimalsAreRounded) {
  EXPECT_EQ(decimals(0.0, 1), "0.0");
  EXPECT_EQ(decimals(2.66, 1), "2.7");
  EXPECT_EQ(decimals(-12.4, 0), "-12");
  EXPECT_EQ(decimals(std::numeric_limits<double>::infinity(), 2), "inf");
  EXPECT_EQ(decimals(1e300, 0).size(), 301U);
}

}  // namespace
}  // namespace waymark
