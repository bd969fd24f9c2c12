#include "waymark/core/result.hpp"

#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace waymark {
namespace {

Result<int> half(int number) {
  if (number % 2 != 0) return Error{std::to_string(number) + " is odd"};
  return number / 2;
}

Result<void> refuse(bool refused) {
  if (refused) return Error{"refused", Error::Kind::kFailed};
  return {};
}

TEST(Result, HoldsAValue) {
  const auto result = half(42);
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(static_cast<bool>(result));
  EXPECT_EQ(result.value(), 21);
  EXPECT_EQ(*result, 21);
}

TEST(Result, HoldsTheReasonWhyNot) {
  const auto result = half(7);
  ASSERT_FALSE(result.ok());
  EXPECT_FALSE(static_cast<bool>(result));
  EXPECT_EQ(result.error().message, "7 is odd");
  EXPECT_EQ(result.error().kind, Error::Kind::kBadInput);
}

TEST(Result, TakesAndGivesWhatCannotBeCopied) {
  Result<std::unique_ptr<int>> result = std::make_unique<int>(5);
  ASSERT_TRUE(result.ok());
  const std::unique_ptr<int> owned = *std::move(result);
  EXPECT_EQ(*owned, 5);
}

TEST(Result, ReachesIntoItsValue) {
  Result<std::string> result = std::string("way");
  result->append("mark");
  *result += "!";
  EXPECT_EQ(result.value(), "waymark!");
  EXPECT_EQ(std::as_const(result)->size(), 8U);
}

TEST(ResultOfNothing, IsDoneUnlessThereIsAReason) {
  EXPECT_TRUE(refuse(false).ok());
  const auto result = refuse(true);
  EXPECT_FALSE(result.ok());
  EXPECT_EQ(result.error().message, "refused");
  EXPECT_EQ(result.error().kind, Error::Kind::kFailed);
}

}  // namespace
}  // namespace waymark
