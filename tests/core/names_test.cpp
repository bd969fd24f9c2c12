#include "waymark/core/names.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(Names, CountsInsertionsDeletionsAndSubstitutions) {
  const std::vector<std::string> known = {"run", "demo", "sim", "eval", "sweep", "calibrate"};
  EXPECT_EQ(nearest_name("swep", known), "sweep");
  EXPECT_EQ(nearest_name("evall", known), "eval");
  EXPECT_EQ(nearest_name("calobrate", known), "calibrate");
  EXPECT_EQ(nearest_name("run", known), "run");
  EXPECT_EQ(nearest_name("xxxxxxxx", known), "");
  EXPECT_EQ(nearest_name("demo", {}), "");
}

TEST(Names, AreSeparatedByCommas) {
  EXPECT_EQ(comma_separated({"a", "b", "c"}), "a, b, c");
  EXPECT_EQ(comma_separated({}), "");
}

TEST(Names, AreOfferedAsAlternatives) {
  EXPECT_EQ(one_of({"a", "b", "c"}), "a, b or c");
  EXPECT_EQ(one_of({"a"}), "a");
  EXPECT_EQ(one_of({}), "");
}

TEST(Names, DistanceCountsInsertedDeletedAndReplacedLetters) {
  EXPECT_EQ(edit_distance("ekf", "ekf"), 0U);
  EXPECT_EQ(edit_distance("", "ekf"), 3U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
}

}  // namespace
}  // namespace waymark
