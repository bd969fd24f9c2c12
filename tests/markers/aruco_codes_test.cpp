#include "waymark/markers/aruco_codes.hpp"

#include <bit>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "waymark/markers/code_book.hpp"

namespace waymark::markers {
namespace {

std::vector<MarkerDictionary> aruco_dictionaries() {
  std::vector<MarkerDictionary> all;
  for (const MarkerDictionary& each : marker_dictionaries())
    if (each.kind == MarkerKind::kAruco) all.push_back(each);
  return all;
}

/// The fewest bits in which two patterns differ, however they are turned.
int min_distance(const MarkerDictionary& dictionary) {
  int least = 64;
  for (int a = 0; a < dictionary.size; ++a) {
    std::uint64_t turned = aruco_code(dictionary, a);
    for (int turns = 0; turns < 4; ++turns, turned = turned_code(turned, dictionary.bits_per_side))
      for (int b = turns == 0 ? a + 1 : a; b < dictionary.size; ++b)
        least = std::min(least, std::popcount(turned ^ aruco_code(dictionary, b)));
  }
  return least;
}

/// The part of random squares of bits that are taken for a marker.
double chance(const MarkerDictionary& dictionary) {
  const int bits = dictionary.bits_per_side * dictionary.bits_per_side;
  double near = 0.0, binomial = 1.0;
  for (int wrong = 0; wrong <= dictionary.corrected_bits; ++wrong) {
    near += binomial;
    binomial *= static_cast<double>(bits - wrong) / (wrong + 1);
  }
  return 4.0 * dictionary.size * near / std::exp2(bits);
}

TEST(ArucoCodes, AreAllDifferentAndOfTheirBits) {
  for (const MarkerDictionary& dictionary : aruco_dictionaries()) {
    std::set<std::uint64_t> codes;
    for (int number = 0; number < dictionary.size; ++number) codes.insert(aruco_code(dictionary, number));
    EXPECT_EQ(codes.size(), static_cast<std::size_t>(dictionary.size)) << dictionary.name;
    EXPECT_EQ(*codes.rbegin() >> (dictionary.bits_per_side * dictionary.bits_per_side), 0U)
        << dictionary.name;
  }
}

/// Two patterns are never equally near to what was read, and chance makes few markers.
TEST(ArucoCodes, AreCorrectedAsFarAsTheyLeaveNoDoubt) {
  for (const MarkerDictionary& dictionary : aruco_dictionaries()) {
    if (dictionary.corrected_bits == 0) continue;
    EXPECT_LT(2 * dictionary.corrected_bits, min_distance(dictionary)) << dictionary.name;
    EXPECT_LT(chance(dictionary), 1.0 / 300.0) << dictionary.name;
  }
}

}  // namespace
}  // namespace waymark::markers
