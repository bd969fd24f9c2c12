#include "waymark/markers/code_book.hpp"

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"
#include "waymark/markers/aruco_codes.hpp"

namespace waymark::markers {
namespace {

std::uint64_t turned_code(std::uint64_t bits, int bits_per_side, int turns) {
  for (; turns > 0; --turns) bits = markers::turned_code(bits, bits_per_side);
  return bits;
}

TEST(CodeBook, TurnsClockwise) {
  EXPECT_EQ(markers::turned_code(0b1000'0000'0000'0000, 4), 0b0001'0000'0000'0000U);
  EXPECT_EQ(markers::turned_code(0b110'000'000, 3), 0b001'001'000U);
  const std::uint64_t bits = 0x1A2B3C4D5E6F7;
  EXPECT_EQ(turned_code(bits, 7, 4), bits);
}

/// Of ArUco's first dictionary some patterns are others, turned.
TEST(CodeBook, RecognisesEveryPatternHoweverItIsTurned) {
  for (const MarkerDictionary& dictionary : marker_dictionaries()) {
    if (dictionary.kind != MarkerKind::kAruco) continue;
    const CodeBook book(dictionary);
    for (int number = 0; number < dictionary.size; ++number)
      for (int turns = 0; turns < 4; ++turns) {
        const std::uint64_t bits =
            turned_code(aruco_code(dictionary, number), dictionary.bits_per_side, turns);
        const auto read = book.find(bits);
        ASSERT_TRUE(read) << dictionary.name << ' ' << number;
        EXPECT_EQ(read->wrong_bits, 0);
        EXPECT_EQ(turned_code(bits, dictionary.bits_per_side, read->turns), aruco_code(dictionary, read->id));
        if (dictionary.name == "aruco_original") continue;
        EXPECT_EQ(read->id, number) << dictionary.name;
        EXPECT_EQ(read->turns, (4 - turns) % 4) << dictionary.name << ' ' << number;
      }
  }
}

TEST(CodeBook, CorrectsAsManyBitsAsTheDictionarySays) {
  RandomStream random(1, StreamPurpose::kWorld);
  for (const char* name : {"5x5_100", "6x6_250", "7x7_1000"}) {
    const MarkerDictionary dictionary = *find_marker_dictionary(name);
    const CodeBook book(dictionary);
    for (int number = 0; number < dictionary.size; number += 7) {
      std::uint64_t bits = aruco_code(dictionary, number);
      const int first = static_cast<int>(random.uniform(0.0, dictionary.bits_per_side));
      for (int i = 0; i < dictionary.corrected_bits; ++i) bits ^= std::uint64_t{1} << (first + 3 * i);
      const auto read = book.find(bits);
      ASSERT_TRUE(read) << name << ' ' << number;
      EXPECT_EQ(read->id, number);
      EXPECT_EQ(read->wrong_bits, dictionary.corrected_bits);
      const auto with_more = book.find(bits ^ std::uint64_t{1} << (first + 1));
      EXPECT_TRUE(!with_more || with_more->id != number) << name << ' ' << number;
    }
  }
}

}  // namespace
}  // namespace waymark::markers
