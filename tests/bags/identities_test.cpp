#include "workbench/bags/identities.hpp"

#include <cmath>

#include <gmock/gmock.h>

namespace waymark::bag {
namespace {

using testing::Optional;

TEST(Identities, AreWholeNumbersFromZeroOn) {
  Identities identities;
  EXPECT_THAT(identities.of_number(0.0), Optional(0));
  EXPECT_THAT(identities.of_number(2147483647.0), Optional(2147483647));
  EXPECT_EQ(identities.unusable(), 0);
  for (const double number : {-1.0, 2147483648.0, 1099511627776.0, 0.5, static_cast<double>(NAN)})
    EXPECT_EQ(identities.of_number(number), std::nullopt) << number;
  EXPECT_EQ(identities.unusable(), 5);
  EXPECT_EQ(identities.example(), "-1");
}

TEST(Identities, OfAListWithoutNumberIsNone) {
  Identities identities;
  EXPECT_EQ(identities.of_number(NAN), std::nullopt);
  EXPECT_EQ(identities.example(), "none");
}

TEST(Identities, AreTheNumbersInTexts) {
  Identities identities;
  EXPECT_THAT(identities.of_text("tag_12"), Optional(12));
  EXPECT_THAT(identities.of_text("tag36h11:7"), Optional(7));
  EXPECT_THAT(identities.of_text("tag_003_left"), Optional(3));
  EXPECT_THAT(identities.of_text("tag_12"), Optional(12)) << "again";
  EXPECT_THAT(identities.of_text("15"), Optional(15));
  EXPECT_THAT(identities.of_text("4.0"), Optional(4));
  EXPECT_EQ(identities.unusable(), 0);
}

TEST(Identities, WithoutANumberOrOutOfRangeCannotBeUsed) {
  for (const char* text : {"", "person", "-1", "1099511627776", "tag_99999999999", "nan"}) {
    Identities identities;
    EXPECT_EQ(identities.of_text(text), std::nullopt) << text;
    EXPECT_EQ(identities.unusable(), 1);
  }
  Identities identities;
  EXPECT_EQ(identities.of_text("person"), std::nullopt);
  EXPECT_EQ(identities.example(), "'person'");
}

TEST(Identities, OfTwoTextsWithOneNumberTheFirstHasIt) {
  Identities identities;
  EXPECT_THAT(identities.of_text("left_1"), Optional(1));
  EXPECT_EQ(identities.of_text("right_1"), std::nullopt);
  EXPECT_THAT(identities.of_text("left_1"), Optional(1));
  EXPECT_EQ(identities.of_text("1"), std::nullopt);
  EXPECT_EQ(identities.unusable(), 2);
  EXPECT_EQ(identities.example(), "'right_1', whose number is that of 'left_1'");
}

}  // namespace
}  // namespace waymark::bag
