#include "workbench/logs/used_bits.hpp"

#include <gmock/gmock.h>

namespace waymark {
namespace {

TEST(UsedBits, AreTheFewestOfAConverterThatHoldAllValues) {
  for (const auto& [largest, bits] : {std::pair{0, 8},
                                      {255, 8},
                                      {256, 10},
                                      {1023, 10},
                                      {1024, 12},
                                      {4095, 12},
                                      {4096, 14},
                                      {16383, 14},
                                      {16384, 16},
                                      {65535, 16}})
    EXPECT_EQ(UsedBits().shift(static_cast<std::uint16_t>(largest)), bits - 8) << largest;
}

TEST(UsedBits, NeverBecomeFewer) {
  UsedBits bits;
  EXPECT_EQ(bits.shift(1000), 2);
  EXPECT_EQ(bits.shift(40), 2) << "a dark image";
  EXPECT_EQ(bits.shift(4000), 4) << "a bright one";
  EXPECT_EQ(bits.shift(40), 4);
}

TEST(UsedBits, AreToldUnlessAllAreUsed) {
  UsedBits bits;
  EXPECT_EQ(bits.note(), "");
  bits.shift(1013);
  EXPECT_EQ(bits.note(), "uses 10 of 16 bits (largest value 1013)");
  bits.shift(60000);
  EXPECT_EQ(bits.note(), "");
}

}  // namespace
}  // namespace waymark
