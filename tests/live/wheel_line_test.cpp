#include "workbench/live/wheel_line.hpp"

#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace waymark::live {
namespace {

TEST(WheelLine, ReadsWhatItWrites) {
  const WheelLine line{4'000'000'000U, 17, -12, std::numeric_limits<std::int32_t>::min()};
  EXPECT_EQ(parse_wheel_line(to_string(line)), line);
  EXPECT_EQ(parse_wheel_line(to_string(line) + "\r"), line);
}

/// The checksum by hand: 'E' ^ ' ' ^ '1' ^ ' ' ^ '2' ^ ' ' ^ '3' ^ ' ' ^ '4' = 0x45 ^ 0x04.
TEST(WheelLine, HasTheChecksumOfTheProtocol) { EXPECT_EQ(to_string(WheelLine{1, 2, 3, 4}), "E 1 2 3 4*41"); }

TEST(WheelLine, RefusesWhatIsNoLine) {
  for (const char* text : {"", "E", "E 1 2 3 4", "E 1 2 3 4*40", "E 1 2 3*55", "E 1 2 3 4 5*54",
                           "X 1 2 3 4*5C", "E 1 2 3 x*0D", "E 1 2 3 99999999999*4C", "*00", "E 1 2 3 4*4"})
    EXPECT_FALSE(parse_wheel_line(text)) << text;
}

TEST(WheelLine, RefusesFlippedBits) {
  const std::string good = to_string(WheelLine{231, 7590, 5693, 7590});
  for (std::size_t at = 0; at < good.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      std::string bad = good;
      bad[at] = static_cast<char>(bad[at] ^ (1 << bit));
      // A digit of the checksum in lower case is as good.
      const auto read = parse_wheel_line(bad);
      EXPECT_TRUE(!read || read == parse_wheel_line(good)) << bad;
    }
}

TEST(WheelCounter, UnwrapsCountsAndClock) {
  WheelCounter counter(100.0);
  const double turn = 2.0 * 3.14159265358979323846;
  EXPECT_EQ(counter.add({7, 4'294'967'290U, 2'147'483'640, -2'147'483'640}).angles.left_rad, 0.0);
  const auto reading = counter.add({8, 4, -2'147'483'646, 2'147'483'646});
  EXPECT_EQ(reading.clock, std::chrono::milliseconds(10));
  EXPECT_NEAR(reading.angles.left_rad, 0.1 * turn, 1e-12);
  EXPECT_NEAR(reading.angles.right_rad, -0.1 * turn, 1e-12);
  EXPECT_EQ(reading.lost, 0U);
  EXPECT_EQ(counter.add({11, 40, -2'147'483'646, 2'147'483'646}).lost, 2U);
}

TEST(WheelCounter, TakesABoardThatBeginsAnewForNoLoss) {
  WheelCounter counter(100.0);
  static_cast<void>(counter.add({500, 1000, 10, 10}));
  EXPECT_EQ(counter.add({0, 2, 0, 0}).lost, 0U);
}

}  // namespace
}  // namespace waymark::live
