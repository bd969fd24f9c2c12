#include "workbench/datasets/rounded_stamps.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace waymark {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Result<TextLines> spread(std::string text) {
  return spread_rounded_stamps(TextLines(std::move(text), "truth.csv"));
}

/// "line: content" of what is left of a table.
std::vector<std::string> rows_of(std::string text) {
  auto lines = spread(std::move(text));
  EXPECT_TRUE(lines.ok()) << lines.error().message;
  std::vector<std::string> rows;
  while (lines->next()) rows.push_back(std::to_string(lines->number()) + ": " + std::string(lines->line()));
  return rows;
}

TEST(RoundedStamps, SpreadsTheRowsOfASecondEvenlyAroundIt) {
  EXPECT_THAT(
      rows_of("7,0\n8,1,2\n8,3,4\n8,5,6\n8,7,8\n9,0\n"),
      ElementsAre("2: 7.500000000 1 2", "3: 7.750000000 3 4", "4: 8.000000000 5 6", "5: 8.250000000 7 8"));
}

TEST(RoundedStamps, SecondsOfDifferentLengthMeetAtTheirEdges) {
  EXPECT_THAT(rows_of("7,0\n8,1\n8,2\n9,3\n10,0\n"),
              ElementsAre("2: 7.500000000 1", "3: 8.000000000 2", "4: 8.500000000 3"));
}

TEST(RoundedStamps, LeavesOutTheFirstAndLastSecondAndKeepsTheNumbersOfLines) {
  EXPECT_THAT(rows_of("\xEF\xBB\xBF# Time [s],x,,\r\n7,1\r\n7,2\r\n\r\n8,3\r\n9,4\r\n9,5"),
              ElementsAre("5: 7.500000000 3"));
  EXPECT_THAT(rows_of("7,1\n7,2\n8,3\n"), IsEmpty());
  EXPECT_THAT(rows_of("7,1\n"), IsEmpty());
  EXPECT_THAT(rows_of("# only a header"), IsEmpty());
}

TEST(RoundedStamps, TheFirstLineMayNameTheColumns) {
  EXPECT_THAT(rows_of("\xEF\xBB\xBFTime [s],x\n7,1\n8,2\n9,3\n"), ElementsAre("3: 7.500000000 2"));
}

TEST(RoundedStamps, RefusesWhatIsNoWholeSecondOrGoesBack) {
  EXPECT_THAT(spread("7,0\n7.5,0\n").error().message,
              HasSubstr("truth.csv:2: '7.5' is not a whole number of seconds"));
  EXPECT_THAT(spread("7,0\ntime,x\n").error().message,
              HasSubstr("truth.csv:2: 'time' is not a whole number"));
  EXPECT_THAT(spread("8,0\n7,0\n").error().message, HasSubstr("truth.csv:2: goes back in time"));
}

}  // namespace
}  // namespace waymark
