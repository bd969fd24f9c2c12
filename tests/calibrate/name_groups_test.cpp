#include "workbench/calibrate/name_groups.hpp"

#include <gtest/gtest.h>

namespace waymark::calibrate {
namespace {

using Names = std::vector<std::string>;

TEST(NameGroups, WithAWordOfTheirOwnAreAPattern) {
  const Names names{"left01.jpg", "left02.jpg", "left14.jpg", "right01.jpg", "right02.jpg"};
  EXPECT_EQ(describe_members(names, {true, true, true, false, false}), "left*.jpg");
  EXPECT_EQ(describe_members(names, {false, false, false, true, true}), "right0*.jpg");
}

TEST(NameGroups, WithAWordAtTheirEndAreAPattern) {
  const Names names{"01_left.jpg", "01_right.jpg", "12_left.jpg", "12_right.jpg"};
  EXPECT_EQ(describe_members(names, {true, false, true, false}), "*_left.jpg");
  EXPECT_EQ(describe_members(names, {false, true, false, true}), "*_right.jpg");
}

TEST(NameGroups, WithoutAWordOfTheirOwnAreRanges) {
  const Names names{"img1.png", "img2.png", "img3.png", "img4.png", "img5.png", "img6.png"};
  EXPECT_EQ(describe_members(names, {true, true, true, false, false, true}),
            "img1.png to img3.png, img6.png");
  const Names times{"0.2 s", "0.4 s", "1.2 s", "1.4 s"};
  EXPECT_EQ(describe_members(times, {false, false, true, true}), "1.2 s to 1.4 s");
}

TEST(NameGroups, OfManyRangesTellTheFirst) {
  Names names;
  std::vector<bool> is_member;
  for (char c = 'a'; c <= 'z'; ++c) {
    names.emplace_back(1, c);
    is_member.push_back(c % 2 == 0);
  }
  EXPECT_EQ(describe_members(names, is_member), "b, d, f, h, ...");
}

TEST(NameGroups, OfOneIsItsName) {
  EXPECT_EQ(describe_members({"a1.png", "a2.png"}, {true, false}), "a1.png");
}

}  // namespace
}  // namespace waymark::calibrate
