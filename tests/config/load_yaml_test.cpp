#include "workbench/config/load_yaml.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

namespace waymark {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string refusal(const std::string& yaml) {
  const auto root = load_yaml(yaml, "f.yaml");
  return root ? "" : root.error().message;
}

/// Maps of maps of maps: each holds ten aliases to the one before, and the first is `innermost`.
std::string laughs(const std::string& innermost, int levels) {
  std::string yaml = "l0: &l0 " + innermost + "\n";
  for (int level = 1; level <= levels; ++level) {
    yaml += fmt::format("l{0}: &l{0}\n", level);
    for (int i = 0; i < 10; ++i) yaml += fmt::format("  k{}: *l{}\n", i, level - 1);
  }
  return yaml;
}

TEST(LoadYaml, GivesTheTree) {
  const auto root = load_yaml("a: &x {b: [1, 2]}\nc: *x\n", "f.yaml");
  ASSERT_TRUE(root.ok());
  EXPECT_EQ((*root)["c"]["b"][1].as<int>(), 2);
  EXPECT_TRUE(load_yaml("", "f.yaml").value().IsNull());
}

TEST(LoadYaml, BadTextIsAnErrorWithItsLine) {
  EXPECT_THAT(refusal("a: 1\nb: [1, 2\n"), StartsWith("f.yaml:"));
  EXPECT_THAT(refusal("a: *nothing\n"), StartsWith("f.yaml:1: "));
}

TEST(LoadYaml, AliasesCountAsWhatTheyStandForAlsoWhereThatIsEmpty) {
  EXPECT_EQ(refusal(laughs("{}", 4)), "");
  for (const char* innermost : {"{}", "[]", "~", "ha"})
    EXPECT_THAT(refusal(laughs(innermost, 14)), HasSubstr("too many values")) << innermost;
}

TEST(LoadYaml, LongTextsCountAsOftenAsAliasesRepeatThem) {
  EXPECT_EQ(refusal("a: &x " + std::string(100'000, 'x') + "\nb: [*x, *x]\n"), "");
  EXPECT_THAT(refusal(laughs(std::string(100'000, 'x'), 2)), HasSubstr("too many values"));
}

TEST(LoadYaml, WhatStandsWithinItselfIsRefused) {
  EXPECT_THAT(refusal("a: &x\n  b: *x\n"), HasSubstr("f.yaml:2: an alias refers to a node that contains it"));
  EXPECT_THAT(refusal("&x [*x]"), HasSubstr("an alias refers to a node"));
}

TEST(LoadYaml, DepthCountsThroughAliases) {
  EXPECT_THAT(refusal(std::string(1000, '[')), HasSubstr("nested too deep"));
  std::string chain = "l0: &l0 {}\n";
  for (int level = 1; level <= 100; ++level) chain += fmt::format("l{0}: &l{0} [*l{1}]\n", level, level - 1);
  EXPECT_THAT(refusal(chain), HasSubstr("nested too deep"));
}

TEST(LoadYaml, ALongListWithoutAliasesMayBeLongAndNotLonger) {
  const auto list = [](int count) {
    std::string yaml;
    for (int i = 0; i < count; ++i) yaml += "- 1\n";
    return yaml;
  };
  EXPECT_EQ(refusal(list(100'000)), "");
  EXPECT_THAT(refusal(list(500'000)), HasSubstr("too many values"));
  EXPECT_THAT(refusal(std::string(10'000'000, '#')), HasSubstr("10000000 bytes of YAML"));
}

}  // namespace
}  // namespace waymark
