#include "workbench/config/flat_yaml.hpp"

#include <gmock/gmock.h>

namespace waymark {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(FlatYaml, JoinsSectionsWithDotsAndKeepsLines) {
  const auto entries = flatten_yaml("a: 1\nb:\n  c: x y\n  d: {e: 2.50}\nempty:\n", "f");
  ASSERT_TRUE(entries.ok());
  ASSERT_EQ(entries->size(), 3U);
  EXPECT_EQ((*entries)[1].key, "b.c");
  EXPECT_EQ((*entries)[1].value, "x y");
  EXPECT_EQ((*entries)[1].line, 3);
  EXPECT_EQ((*entries)[2].key, "b.d.e");
  EXPECT_EQ((*entries)[2].value, "2.50");
}

TEST(FlatYaml, EmptyTextHasNoEntries) { EXPECT_TRUE(flatten_yaml("# nothing\n", "f").value().empty()); }

TEST(FlatYaml, BadTextIsAnErrorWithItsLine) {
  EXPECT_THAT(flatten_yaml("a: 1\nb: [1, 2\n", "f.yaml").error().message, StartsWith("f.yaml:"));
  EXPECT_THAT(flatten_yaml("a: 1\nb: [1, 2]\n", "f.yaml").error().message,
              HasSubstr("f.yaml:2: b cannot be a list"));
  EXPECT_THAT(flatten_yaml("just text", "f.yaml").error().message, HasSubstr("key: value"));
  EXPECT_THAT(flatten_yaml("? [1, 2]\n: 3\n", "f.yaml").error().message, HasSubstr("plain name"));
}

TEST(FlatYaml, WhatIsGoneThroughCountsAlsoWhereNothingComesOfIt) {
  std::string yaml = "a: &a {}\nb: &b {";
  for (char c = 'a'; c <= 'z'; ++c) yaml += std::string(1, c) + ": *a, ";
  yaml += "}\n";
  for (int i = 0; i < 1000; ++i) yaml += "k" + std::to_string(i) + ": *b\n";
  EXPECT_THAT(flatten_yaml(yaml, "f.yaml").error().message, HasSubstr("too many keys"));
}

TEST(FlatYaml, SectionsDoNotAddUpToKeysWithoutEnd) {
  const std::string section(300, 's');
  EXPECT_TRUE(flatten_yaml(section + ": {a: 1}\n", "f.yaml").ok());
  EXPECT_THAT(flatten_yaml(section + ": {" + section + ": 1}\n", "f.yaml").error().message,
              HasSubstr("f.yaml:1: a key of 601 characters"));
}

TEST(FlatYaml, MapWithinItselfEnds) {
  EXPECT_THAT(flatten_yaml("a: &x\n  b: *x\n", "f.yaml").error().message, StartsWith("f.yaml:"));
}

}  // namespace
}  // namespace waymark
