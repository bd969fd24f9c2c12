#include "workbench/logs/text_table.hpp"

#include <utility>

#include <gmock/gmock.h>

#include "support/io_support.hpp"

namespace waymark {
namespace {

using testing::HasSubstr;

const TableLayout kWheels{"stamp_s,left_rad,right_rad", TableLayout::Separator::kComma, ""};
const TableLayout kTruth{"stamp_s,x_m,theta_rad", TableLayout::Separator::kComma, "theta_rad"};
const TableLayout kBlank{"stamp_s,v_mps,w_radps", TableLayout::Separator::kBlank, ""};

Result<TextTable> table_of(std::string text, const TableLayout& layout = kWheels) {
  return TextTable::from(TextLines(std::move(text), "wheels.csv"), layout);
}

/// The first error when all rows are read as (stamp, number, number); empty if there is none.
std::string table_error(std::string text, const TableLayout& layout = kWheels) {
  auto table = table_of(std::move(text), layout);
  if (!table) return table.error().message;
  while (table->next()) {
    (void)table->ordered_stamp(0);
    (void)table->number(1);
    (void)table->number(2);
  }
  return table->error() ? table->error()->message : "";
}

TEST(TextTable, ReadsRowsByTheNamesInTheHeader) {
  auto table = table_of("right_rad, stamp_s ,left_rad\r\n3,1.5,2\r\n");
  ASSERT_TRUE(table.ok());
  ASSERT_TRUE(table->next());
  EXPECT_EQ(table->stamp(0), Stamp{Duration{1'500'000'000}});
  EXPECT_EQ(table->number(1), 2.0);
  EXPECT_EQ(table->number(2), 3.0);
  EXPECT_FALSE(table->next());
  EXPECT_FALSE(table->error());
}

TEST(TextTable, ReadsColumnsBetweenBlanksWithoutHeader) {
  auto table = table_of("# stamp v w\n  1 \t 0.5 \t -2 \n", kBlank);
  ASSERT_TRUE(table.ok() && table->next());
  EXPECT_EQ(table->number(1), 0.5);
  EXPECT_EQ(table->number(2), -2.0);
}

TEST(TextTable, ColumnThatMayLackReadsAsEmpty) {
  auto table = table_of("stamp_s,x_m\n1,2\n", kTruth);
  ASSERT_TRUE(table.ok() && table->next());
  EXPECT_TRUE(table->is_empty(2));
}

TEST(TextTable, StampsAreExact) {
  auto table = table_of("1248444175.103000001 0 0\n", kBlank);
  ASSERT_TRUE(table.ok() && table->next());
  EXPECT_EQ(table->stamp(0), Stamp{Duration{1248444175103000001}});
}

TEST(TextTable, WholeNumbersMayBeWrittenAsOthers) {
  auto table = table_of("stamp_s,left_rad,right_rad\n3,-3.000,1e2\n2147483648.0,2.5,nan\n");
  ASSERT_TRUE(table.ok() && table->next());
  EXPECT_EQ(table->integer(0), 3);
  EXPECT_EQ(table->integer(1), -3);
  EXPECT_EQ(table->integer(2), 100);
  ASSERT_TRUE(table->next());
  EXPECT_EQ(table->integer(0), 0);
  EXPECT_THAT(table->error().value().message, HasSubstr("'2147483648.0' is not a whole number"));
}

TEST(TextTable, EqualStampsAreInOrder) {
  EXPECT_EQ(table_error("stamp_s,left_rad,right_rad\n1,2,3\n1,2,3\n"), "");
}

TEST(TextTable, LastRowMayLackItsEnd) { EXPECT_EQ(table_error("stamp_s,left_rad,right_rad\n1,2,3"), ""); }

struct BadTable {
  const char* rows;
  const char* error;
};

class BadRows : public testing::TestWithParam<BadTable> {};

TEST_P(BadRows, AreErrorsWithFileLineAndWhatWouldBeRight) {
  const std::string header = "stamp_s,left_rad,right_rad\n";
  EXPECT_EQ(table_error(header + GetParam().rows), GetParam().error);
}

INSTANTIATE_TEST_SUITE_P(
    TextTable, BadRows,
    testing::Values(
        BadTable{"1,2\n", "wheels.csv:2: expected 3 columns (stamp_s,left_rad,right_rad), found 2"},
        BadTable{"1,2,3,\n", "wheels.csv:2: expected 3 columns (stamp_s,left_rad,right_rad), found 4"},
        BadTable{"1,2,3\n2,2",
                 "wheels.csv:3: expected 3 columns (stamp_s,left_rad,right_rad), found 2 (the file is cut "
                 "off in this line)"},
        BadTable{"1,abc,3\n", "wheels.csv:2: 'abc' is not a number in column left_rad"},
        BadTable{"1,2,3x\n", "wheels.csv:2: '3x' is not a number in column right_rad"},
        BadTable{"1,nan,3\n", "wheels.csv:2: 'nan' is not a finite number in column left_rad"},
        BadTable{"1,2,-inf\n", "wheels.csv:2: '-inf' is not a finite number in column right_rad"},
        BadTable{"1,2,1e999\n", "wheels.csv:2: '1e999' is not a number in column right_rad"},
        BadTable{"1,,3\n", "wheels.csv:2: column left_rad is empty; it needs a number"},
        BadTable{"nan,2,3\n", "wheels.csv:2: 'nan' is not a number of seconds in column stamp_s"},
        BadTable{"1700000000000,2,3\n",
                 "wheels.csv:2: '1700000000000' is not a number of seconds in column stamp_s: is it in "
                 "milliseconds? Divide the column by 1e3"},
        BadTable{"1700000000000000000,2,3\n",
                 "wheels.csv:2: '1700000000000000000' is not a number of seconds in column stamp_s: is it in "
                 "nanoseconds? Divide the column by 1e9"},
        BadTable{",2,3\n", "wheels.csv:2: column stamp_s is empty; it needs a number of seconds"},
        BadTable{"\x01-\xFF,2,3\n", "wheels.csv:2: '?-?' is not a number of seconds in column stamp_s"},
        BadTable{
            "2,2,3\n# why\n1.5,2,3\n",
            "wheels.csv:4: stamp 1.500000000 is before 2.000000000 in line 2; rows must be sorted by time"}));

TEST(TextTable, HeaderErrorsNameWhatIsWrong) {
  EXPECT_EQ(table_error(""),
            "wheels.csv: the file is empty; its first line must be stamp_s,left_rad,right_rad");
  EXPECT_EQ(table_error("stamp_s,left_rad\n"),
            "wheels.csv:1: column right_rad is missing; the columns are stamp_s,left_rad,right_rad");
  EXPECT_THAT(table_error("stamp_s,left_rda,right_rad\n"), HasSubstr("'left_rda', did you mean left_rad?"));
  EXPECT_THAT(table_error("stamp_s,left_rad,left_rad,right_rad\n"), HasSubstr("left_rad is listed twice"));
  EXPECT_THAT(table_error("1.0,2.0,3.0\n"), HasSubstr("unknown column '1.0'"));
}

TEST(TextTable, WithoutHeaderTheColumnsAreNamedInErrors) {
  EXPECT_EQ(table_error("1 2\n", kBlank),
            "wheels.csv:1: expected 3 columns (stamp_s,v_mps,w_radps), found 2");
}

TEST(TextTable, FirstErrorEndsTheReading) {
  auto table = table_of("1 x y\n2 3 4\n", kBlank);
  ASSERT_TRUE(table.ok() && table->next());
  EXPECT_EQ(table->number(1), 0.0);
  EXPECT_EQ(table->number(2), 0.0);
  EXPECT_THAT(table->error().value().message, HasSubstr("'x'"));
  EXPECT_FALSE(table->next());
}

TEST(TextTable, OpensFilesAndNamesMissingOnes) {
  const test::TempFolder folder;
  const auto file = folder.write("a.csv", "stamp_s,left_rad,right_rad\n1,2,3\n");
  EXPECT_TRUE(TextTable::open(file, kWheels).ok());
  EXPECT_THAT(TextTable::open(folder.path() / "b.csv", kWheels).error().message, HasSubstr("b.csv"));
}

}  // namespace
}  // namespace waymark
