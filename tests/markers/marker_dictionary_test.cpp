#include "waymark/markers/marker_dictionary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::markers {
namespace {

using testing::HasSubstr;

TEST(MarkerDictionary, IsFoundByItsName) {
  for (const MarkerDictionary& each : marker_dictionaries()) {
    const auto found = find_marker_dictionary(each.name);
    ASSERT_TRUE(found.ok()) << each.name;
    EXPECT_EQ(found->name, each.name);
    EXPECT_EQ(found->size, each.size);
  }
}

TEST(MarkerDictionary, IsFoundAsOthersWriteIt) {
  EXPECT_EQ(find_marker_dictionary("DICT_4X4_50")->name, "4x4_50");
  EXPECT_EQ(find_marker_dictionary("DICT_ARUCO_ORIGINAL")->name, "aruco_original");
  EXPECT_EQ(find_marker_dictionary("tag36h11")->name, "apriltag_36h11");
  EXPECT_EQ(find_marker_dictionary("36h10")->name, "apriltag_36h10");
  EXPECT_EQ(find_marker_dictionary("DICT_APRILTAG_25h9")->name, "apriltag_25h9");
}

TEST(MarkerDictionary, UnknownNameListsAll) {
  const auto found = find_marker_dictionary("4x4_60");
  ASSERT_FALSE(found.ok());
  EXPECT_THAT(found.error().message, HasSubstr("markers.dictionary: unknown dictionary '4x4_60'"));
  for (const MarkerDictionary& each : marker_dictionaries())
    EXPECT_THAT(found.error().message, HasSubstr(std::string(each.name)));
}

TEST(MarkerDictionary, SmallestHoldsTheNumber) {
  const MarkerDictionary large = *find_marker_dictionary("6x6_1000");
  EXPECT_EQ(smallest_with(large, 49).name, "6x6_50");
  EXPECT_EQ(smallest_with(large, 50).name, "6x6_100");
  EXPECT_EQ(smallest_with(large, 203).name, "6x6_250");
  EXPECT_EQ(smallest_with(large, 999).name, "6x6_1000");
  EXPECT_EQ(smallest_with(*find_marker_dictionary("36h11"), 3).name, "apriltag_36h11");
  EXPECT_EQ(smallest_with(*find_marker_dictionary("aruco_original"), 3).name, "aruco_original");
}

}  // namespace
}  // namespace waymark::markers
