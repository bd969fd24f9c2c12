#include "workbench/logs/number_text.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"

#include "workbench/logs/text_lines.hpp"

namespace waymark {
namespace {

std::string shortest(double value) {
  std::string text;
  append_shortest(text, value);
  return text;
}

std::string fixed(double value) {
  std::string text;
  append_fixed(text, value);
  return text;
}

TEST(NumberText, ShortestReadsBackTheSameBits) {
  RandomStream random(1, StreamPurpose::kSimulation);
  for (int i = 0; i < 1000; ++i) {
    const double value = random.normal() * std::pow(10.0, random.uniform(-300.0, 300.0));
    EXPECT_EQ(parse_number(shortest(value)), value);
  }
  EXPECT_EQ(shortest(0.1), "0.1");
}

TEST(NumberText, FixedHasNineDecimals) {
  EXPECT_EQ(fixed(0.0), "0.000000000");
  EXPECT_EQ(fixed(-1.5), "-1.500000000");
  EXPECT_EQ(fixed(-1e-12), "0.000000000");
  EXPECT_EQ(fixed(0.9999999996), "1.000000000");
  EXPECT_EQ(fixed(1e15), "1000000000000000.000000000");
  EXPECT_GT(fixed(std::numeric_limits<double>::max()).size(), 309U);
}

TEST(NumberText, FixedIsNearEveryNumber) {
  RandomStream random(2, StreamPurpose::kSimulation);
  for (int i = 0; i < 1000; ++i) {
    const double value = random.uniform(-1e4, 1e4);
    EXPECT_NEAR(parse_number(fixed(value)).value(), value, 0.6e-9);
  }
}

TEST(NumberText, StampIsExact) {
  for (const std::int64_t nanos : {std::int64_t{0}, std::int64_t{-1}, std::int64_t{1248444175103000001},
                                   std::int64_t{-23202000}, std::numeric_limits<std::int64_t>::min()}) {
    const Stamp stamp{Duration{nanos}};
    std::string text;
    append_stamp(text, stamp);
    EXPECT_EQ(text, to_string(stamp));
  }
}

}  // namespace
}  // namespace waymark
