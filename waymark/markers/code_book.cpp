#include "waymark/markers/code_book.hpp"

#include <bit>

#include "waymark/markers/aruco_codes.hpp"

namespace waymark::markers {

std::uint64_t turned_code(std::uint64_t bits, int bits_per_side) {
  std::uint64_t turned = 0;
  for (int row = 0; row < bits_per_side; ++row)
    for (int column = 0; column < bits_per_side; ++column) {
      const int from = (bits_per_side - 1 - column) * bits_per_side + row;
      turned = turned << 1 | (bits >> (bits_per_side * bits_per_side - 1 - from) & 1);
    }
  return turned;
}

CodeBook::CodeBook(const MarkerDictionary& dictionary)
    : bits_per_side_(dictionary.bits_per_side), corrected_bits_(dictionary.corrected_bits) {
  for (int number = 0; number < dictionary.size; ++number) codes_.push_back(aruco_code(dictionary, number));
}

std::optional<ReadCode> CodeBook::find(std::uint64_t bits) const {
  std::optional<ReadCode> best;
  for (int turns = 0; turns < 4; ++turns, bits = turned_code(bits, bits_per_side_))
    for (std::size_t i = 0; i < codes_.size(); ++i) {
      const int wrong_bits = std::popcount(bits ^ codes_[i]);
      if (wrong_bits <= (best ? best->wrong_bits - 1 : corrected_bits_))
        best = ReadCode{static_cast<std::int32_t>(i), turns, wrong_bits};
    }
  return best;
}

}  // namespace waymark::markers
