#include "workbench/live/line_splitter.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace waymark::live {
namespace {

std::vector<std::string> split(LineSplitter& lines, const std::vector<std::string>& pieces) {
  std::vector<std::string> all;
  for (const std::string& piece : pieces)
    lines.add(piece, [&](std::string_view line) { all.emplace_back(line); });
  return all;
}

TEST(LineSplitter, JoinsWhatComesInPieces) {
  LineSplitter lines;
  EXPECT_EQ(split(lines, {"ab", "c\nd", "\r\n\n", "e\nf"}), (std::vector<std::string>{"abc", "d", "e"}));
}

TEST(LineSplitter, PassesOverALineWithoutEnd) {
  LineSplitter lines;
  const std::string noise(100'000, 'x');
  EXPECT_EQ(split(lines, {"a\n", noise, noise, "\nb\n"}), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(lines.passed_over(), 1);
}

}  // namespace
}  // namespace waymark::live
