#include "workbench/logs/text_lines.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

namespace waymark {
namespace {

std::vector<std::pair<int, std::string>> lines_of(std::string text) {
  TextLines lines(std::move(text), "x");
  std::vector<std::pair<int, std::string>> all;
  while (lines.next()) all.emplace_back(lines.number(), lines.line());
  return all;
}

using Lines = std::vector<std::pair<int, std::string>>;

TEST(TextLines, TakesByteOrderMarkCarriageReturnsCommentsAndAMissingLastEnd) {
  EXPECT_EQ(lines_of("\xEF\xBB\xBF"
                     "a b\r\n\r\n# no\n  c \n\nd"),
            (Lines{{1, "a b"}, {4, "c"}, {6, "d"}}));
}

TEST(TextLines, NothingHasNoLines) {
  EXPECT_EQ(lines_of(""), Lines{});
  EXPECT_EQ(lines_of("\n \n#"), Lines{});
}

TEST(TextLines, ErrorNamesFileAndLineAndWhetherTheFileBreaksOff) {
  TextLines lines("a\nb", "f.csv");
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.error("bad").message, "f.csv:1: bad");
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.error("bad").message, "f.csv:2: bad (the file is cut off in this line)");
}

TEST(TextLines, ViewsStayValidWhenMoved) {
  TextLines lines("ab\n", "x");
  ASSERT_TRUE(lines.next());
  const TextLines moved = std::move(lines);
  EXPECT_EQ(moved.line(), "ab");
}

TEST(TextLines, TakesWordsAndCells) {
  std::string_view words = " a \tbc";
  EXPECT_EQ(take_word(words), "a");
  EXPECT_EQ(take_word(words), "bc");
  EXPECT_EQ(take_word(words), "");
  std::string_view cells = "a , ,b";
  EXPECT_EQ(take_cell(cells), "a");
  EXPECT_EQ(take_cell(cells), "");
  EXPECT_EQ(take_cell(cells), "b");
}

TEST(TextLines, NumbersMustFillTheText) {
  EXPECT_EQ(parse_number("-1.5e3"), -1500.0);
  EXPECT_EQ(parse_number("+2"), 2.0);
  EXPECT_TRUE(std::isnan(parse_number("nan").value()));
  for (const char* bad : {"", "1x", "1,2", "+-1", "--1", "0x10", " 1", "1e999"})
    EXPECT_FALSE(parse_number(bad)) << bad;
  EXPECT_EQ(parse_integer("-7"), -7);
  for (const char* bad : {"", "1.0", "99999999999"}) EXPECT_FALSE(parse_integer(bad)) << bad;
}

TEST(TextLines, QuotesForErrorsAreShortAndPrintable) {
  EXPECT_EQ(in_quotes("\x01\xFFz"),
            "'?"
            "?z'");
  EXPECT_LT(in_quotes(std::string(1000, 'x')).size(), 50U);
}

}  // namespace
}  // namespace waymark
