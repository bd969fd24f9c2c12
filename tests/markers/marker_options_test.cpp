#include "waymark/markers/marker_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::markers {
namespace {

using testing::HasSubstr;

std::string error_of(const MarkerOptions& options) {
  const auto set = marker_set(options);
  return set.ok() ? "none" : set.error().message;
}

TEST(MarkerOptions, SayWhatTheyLack) {
  EXPECT_THAT(error_of({}), HasSubstr("markers.dictionary is not set"));
  EXPECT_THAT(error_of({.dictionary = "4x4_50"}), HasSubstr("markers.size_m is not set"));
  EXPECT_THAT(error_of({.dictionary = "4x5_50", .size_m = 0.1}), HasSubstr("unknown dictionary"));
  EXPECT_EQ(error_of({.dictionary = "4x4_50", .size_m = 0.1}), "none");
}

TEST(MarkerOptions, SizesMayDiffer) {
  const auto set = marker_set({.dictionary = "4x4_50", .size_m = 0.1, .sizes_m = "{3: 0.25, 7:0.05}"});
  ASSERT_TRUE(set.ok());
  EXPECT_EQ(set->size_of(3), 0.25);
  EXPECT_EQ(set->size_of(7), 0.05);
  EXPECT_EQ(set->size_of(8), 0.1);
}

TEST(MarkerOptions, WithSizesAloneOthersHaveNone) {
  const auto set = marker_set({.dictionary = "4x4_50", .sizes_m = "3: 0.25"});
  ASSERT_TRUE(set.ok());
  EXPECT_EQ(set->size_of(3), 0.25);
  EXPECT_EQ(set->size_of(4), 0.0);
}

TEST(MarkerOptions, RefuseSizesOfNothing) {
  for (const char* sizes :
       {"3", "3:", ":0.1", "x: 0.1", "50: 0.1", "-1: 0.1", "3: -0.1", "3: 0", "3: nan", "3: 0.1 m"})
    EXPECT_THAT(error_of({.dictionary = "4x4_50", .size_m = 0.1, .sizes_m = sizes}),
                HasSubstr("markers.sizes_m"))
        << sizes;
}

}  // namespace
}  // namespace waymark::markers
