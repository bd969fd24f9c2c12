#include "workbench/config/key_parts.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(KeyParts, AreTheSectionWithItsDotAndWhatIsBehindTheLastDot) {
  EXPECT_EQ(section_of("map.capacity"), "map.");
  EXPECT_EQ(last_part("map.capacity"), "capacity");
  EXPECT_EQ(section_of("a.b.c"), "a.");
  EXPECT_EQ(last_part("a.b.c"), "c");
}

TEST(KeyParts, OfAKeyWithoutSectionAreNoneAndItself) {
  EXPECT_EQ(section_of("seed"), "");
  EXPECT_EQ(last_part("seed"), "seed");
}

}  // namespace
}  // namespace waymark
