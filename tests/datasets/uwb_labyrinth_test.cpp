#include "workbench/datasets/uwb_labyrinth.hpp"

#include <gmock/gmock.h>

#include "support/data_dir.hpp"
#include "support/io_support.hpp"

namespace waymark {
namespace {

using test::only;
using test::TempFolder;
using testing::HasSubstr;

constexpr const char* kInput =
    "range2 1.0 2.5 0.01 -0.02 2.365 107 0 \n"
    "odom2diff 1.0 0.1 0.2 0 0.0785 0.0001 0.0001 0.0001 \n"
    "odom2diff 1.5 0.3 0.4 0 0.0785 0.0001 0.0001 0.0001 \n"
    "range2 1.5 2.6 0.01 -0.02 2.365 107 0 \n";

TEST(UwbLabyrinth, SumsUpWheelsAndReadsRangesAnchorsAndTruth) {
  const TempFolder folder;
  folder.write("Indoor_UWB_Input.txt", kInput);
  folder.write("Indoor_UWB_GT.txt", "point2 1.0 1.6 2.2 0 0 0 0 \n");
  EXPECT_TRUE(is_uwb_labyrinth(folder.path()));
  const auto source = open_uwb_labyrinth(folder.path()).value();
  const auto events = test::read_all(*source).events;
  const auto wheels = only<WheelAngles>(events);
  ASSERT_EQ(wheels.size(), 2U);
  EXPECT_EQ(wheels[0].second.left_rad, 0.0);
  EXPECT_DOUBLE_EQ(wheels[1].second.left_rad, 0.05);
  EXPECT_DOUBLE_EQ(wheels[1].second.right_rad, 0.1);
  const auto ranges = only<Observations>(events);
  ASSERT_EQ(ranges.size(), 2U);
  EXPECT_EQ(std::get<Range>(ranges[1].second[0].value).range_m, 2.6);
  ASSERT_EQ(source->info().landmarks.size(), 1U);
  EXPECT_EQ(source->info().landmarks[0].id.number, 107);
  EXPECT_EQ(source->info().landmarks[0].y_m, 2.365);
  ASSERT_EQ(only<Truth>(events).size(), 1U);
  EXPECT_FALSE(only<Truth>(events)[0].second.theta_rad.has_value());
}

TEST(UwbLabyrinth, BadLinesAreNamed) {
  const TempFolder folder;
  const auto error_of = [&folder](const char* line) {
    folder.write("Indoor_UWB_Input.txt", line);
    return open_uwb_labyrinth(folder.path()).error().message;
  };
  EXPECT_THAT(error_of("range3 1 2\n"), HasSubstr("Indoor_UWB_Input.txt:1: 'range3' is not a known kind"));
  EXPECT_THAT(error_of("range2 1 2 3 4\n"), HasSubstr(":1: expected 7 numbers after range2"));
  EXPECT_THAT(error_of("range2 x\n"), HasSubstr("'x' is not a time in seconds"));
  EXPECT_THAT(error_of("range2 1 two 0.01 0 0 107 0\n"), HasSubstr("'two' is not a number"));
  EXPECT_THAT(error_of("range2 1 -2 0.01 0 0 107 0\n"), HasSubstr("a range cannot be negative"));
  EXPECT_THAT(error_of("range2 1 2 0.01 0 0 1e9 0\n"), HasSubstr("not the number of an anchor"));
}

TEST(UwbLabyrinth, RecordingHoldsTheKnownCounts) {
  WAYMARK_REQUIRE_DATA("uwb-labyrinth");
  const auto source = open_uwb_labyrinth(test::data_path("uwb-labyrinth"));
  ASSERT_TRUE(source.ok()) << source.error().message;
  const auto events = test::read_all(**source).events;
  EXPECT_EQ(only<WheelAngles>(events).size(), 233U);
  EXPECT_EQ(only<Observations>(events).size(), 233U);
  EXPECT_EQ(only<Truth>(events).size(), 233U);
  EXPECT_EQ((*source)->info().landmarks.size(), 4U);
}

}  // namespace
}  // namespace waymark
