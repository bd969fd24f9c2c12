#include "workbench/logs/stamp_unit.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace waymark {
namespace {

std::vector<double> every(double step, double from = 0.0, int count = 50) {
  std::vector<double> counts;
  for (int i = 0; i < count; ++i) counts.push_back(from + step * i);
  return counts;
}

TEST(StampUnit, TimeSince1970TellsItsUnitBySize) {
  EXPECT_EQ(unit_of(every(0.1, 1.7e9)), StampUnit::kSeconds);
  EXPECT_EQ(unit_of(every(100.0, 1.7e12)), StampUnit::kMilliseconds);
  EXPECT_EQ(unit_of(every(1e5, 1.7e15)), StampUnit::kMicroseconds);
  EXPECT_EQ(unit_of(every(1e8, 1.7e18)), StampUnit::kNanoseconds);
  EXPECT_EQ(unit_of(every(60.0, 1.7e9)), StampUnit::kSeconds) << "a surveyed mark every minute";
}

TEST(StampUnit, OtherTimeTellsItByThePaceOfItsRows) {
  EXPECT_EQ(unit_of(every(1.0)), StampUnit::kSeconds);
  EXPECT_EQ(unit_of(every(3.0)), StampUnit::kSeconds);
  EXPECT_EQ(unit_of(every(33.5)), StampUnit::kSeconds) << "with decimals";
  EXPECT_EQ(unit_of(every(50.0)), StampUnit::kMilliseconds);
  EXPECT_EQ(unit_of(every(33'333.0)), StampUnit::kMicroseconds);
  EXPECT_EQ(unit_of(every(5e7)), StampUnit::kNanoseconds);
  EXPECT_EQ(unit_of(every(5e7, 2e9)), StampUnit::kNanoseconds) << "since a start 2 s before";
  EXPECT_EQ(unit_of({}), StampUnit::kSeconds);
  EXPECT_EQ(unit_of(std::vector{5.0}), StampUnit::kSeconds);
}

TEST(StampUnit, RepeatedStampsDoNotHideThePace) {
  std::vector<double> counts;
  for (const double count : every(50.0)) counts.insert(counts.end(), 4, count);
  EXPECT_EQ(unit_of(counts), StampUnit::kMilliseconds);
}

TEST(StampUnit, OnlyStampsTooLargeForSecondsAreDoubted) {
  EXPECT_FALSE(unit_of_large_stamp(1.7e9));
  EXPECT_EQ(unit_of_large_stamp(1.7e12), StampUnit::kMilliseconds);
  EXPECT_EQ(unit_of_large_stamp(1.7e15), StampUnit::kMicroseconds);
  EXPECT_EQ(unit_of_large_stamp(1.7e18), StampUnit::kNanoseconds);
  EXPECT_EQ(unit_of_large_stamp(1.2e10), StampUnit::kNanoseconds);
}

TEST(StampUnit, StampsAreReadExactly) {
  EXPECT_EQ(parse_stamp("1700000000123456789", StampUnit::kNanoseconds),
            Stamp{Duration{1700000000123456789}});
  EXPECT_EQ(parse_stamp("1700000000123456789.000", StampUnit::kNanoseconds),
            Stamp{Duration{1700000000123456789}});
  EXPECT_EQ(parse_stamp("1700000000123.456789", StampUnit::kMilliseconds),
            Stamp{Duration{1700000000123456789}});
  EXPECT_EQ(parse_stamp("-5", StampUnit::kMicroseconds), Stamp{Duration{-5000}});
  EXPECT_EQ(parse_stamp("1.7e18", StampUnit::kNanoseconds), stamp_from_seconds(1.7e9));
  EXPECT_EQ(parse_stamp("1.5", StampUnit::kSeconds), stamp_from_seconds(1.5));
  for (const char* bad : {"", "-", "x", "5 ", "inf", "nan", "1e99"})
    EXPECT_FALSE(parse_stamp(bad, StampUnit::kMilliseconds)) << bad;
}

}  // namespace
}  // namespace waymark
