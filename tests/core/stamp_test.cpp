#include "waymark/core/stamp.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"

namespace waymark {
namespace {

Stamp from_nanos(std::int64_t nanos) { return {Duration{nanos}}; }

struct ParseCase {
  const char* text;
  std::int64_t nanos;
};

TEST(ParseStamp, ReadsDecimalsExactly) {
  for (const auto& [text, nanos] :
       {ParseCase{"1248444175.103", 1248444175103000000},
        ParseCase{"1248444175.123456789", 1248444175123456789}, ParseCase{"0", 0}, ParseCase{"-0", 0},
        ParseCase{"5", 5000000000}, ParseCase{"5.", 5000000000}, ParseCase{".5", 500000000},
        ParseCase{"-.5", -500000000}, ParseCase{"-0.000000001", -1}, ParseCase{"-12.25", -12250000000},
        ParseCase{"007.5", 7500000000}, ParseCase{"0.1", 100000000},
        ParseCase{"8999999999.999999999", 8999999999999999999},
        ParseCase{"-8999999999.999999999", -8999999999999999999}}) {
    const auto stamp = parse_stamp(text);
    ASSERT_TRUE(stamp.has_value()) << text;
    EXPECT_EQ(*stamp, from_nanos(nanos)) << text;
  }
}

TEST(ParseStamp, CutsOffWhatIsBelowANanosecond) {
  EXPECT_EQ(parse_stamp("1.0000000019999"), from_nanos(1000000001));
  EXPECT_EQ(parse_stamp("-1.0000000019999"), from_nanos(-1000000001));
}

TEST(ParseStamp, ReadsExponentsAndLongNumbersThroughADouble) {
  EXPECT_EQ(parse_stamp("1.5e3"), from_nanos(1500000000000));
  EXPECT_EQ(parse_stamp("-25E-2"), from_nanos(-250000000));
  EXPECT_EQ(parse_stamp("000000000012.5"), from_nanos(12500000000));
}

TEST(ParseStamp, RefusesEverythingElse) {
  for (const char* text : {"",
                           " ",
                           "-",
                           ".",
                           "-.",
                           "+1",
                           "1 ",
                           " 1",
                           "1,5",
                           "1.2.3",
                           "--1",
                           "1-",
                           "12x",
                           "x12",
                           "0x10",
                           "1e",
                           "e5",
                           "nan",
                           "inf",
                           "-inf",
                           "infinity",
                           "1e400",
                           "9000000000",
                           "-9000000000",
                           "1248444175103",
                           "1248444175103000000",
                           "1:30",
                           "1.5\r"})
    EXPECT_FALSE(parse_stamp(text).has_value()) << "'" << text << "'";
}

TEST(ParseStamp, IsTheInverseOfToString) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 20000; ++i) {
    // All magnitudes from a nanosecond to 285 years.
    const double magnitude = std::exp(random.uniform(0.0, std::log(8.999e18)));
    const Stamp stamp = from_nanos(std::llround(i % 2 == 0 ? magnitude : -magnitude));
    EXPECT_EQ(parse_stamp(to_string(stamp)), stamp) << to_string(stamp);
  }
}

TEST(ToString, HasNineDecimals) {
  EXPECT_EQ(to_string(from_nanos(0)), "0.000000000");
  EXPECT_EQ(to_string(from_nanos(-1)), "-0.000000001");
  EXPECT_EQ(to_string(from_nanos(1248444175103000000)), "1248444175.103000000");
}

TEST(ToString, CanSayTheMostExtremeStamps) {
  EXPECT_EQ(to_string(from_nanos(std::numeric_limits<std::int64_t>::max())), "9223372036.854775807");
  EXPECT_EQ(to_string(from_nanos(std::numeric_limits<std::int64_t>::min())), "-9223372036.854775808");
}

TEST(DurationFromSeconds, RoundsToTheNearestNanosecond) {
  EXPECT_EQ(duration_from_seconds(0.1), Duration{100000000});
  EXPECT_EQ(duration_from_seconds(-0.1), Duration{-100000000});
  EXPECT_EQ(duration_from_seconds(1.6e-9), Duration{2});
  EXPECT_EQ(stamp_from_seconds(2.5), from_nanos(2500000000));
}

TEST(Stamp, HasTheArithmeticOfTimePoints) {
  const Stamp a = from_nanos(1000), b = from_nanos(1500);
  EXPECT_LT(a, b);
  EXPECT_EQ(b - a, Duration{500});
  EXPECT_EQ(a + Duration{500}, b);
  EXPECT_EQ(b - Duration{500}, a);
  EXPECT_DOUBLE_EQ(to_seconds(Duration{1500000000}), 1.5);
  EXPECT_DOUBLE_EQ(to_seconds(from_nanos(-250000000)), -0.25);
}

}  // namespace
}  // namespace waymark
