#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "waymark/markers/marker_dictionary.hpp"

namespace waymark::markers {

/// A pattern that was recognised.
struct ReadCode {
  std::int32_t id = 0;
  int turns = 0;  ///< clockwise by quarters, until the upper left of the pattern is in the upper left
  int wrong_bits = 0;
};

/// The pattern turned by a quarter, clockwise; bits row after row, the first the highest.
[[nodiscard]] std::uint64_t turned_code(std::uint64_t bits, int bits_per_side);

/// Recognises the patterns of an ArUco dictionary however they are turned.
class CodeBook {
 public:
  explicit CodeBook(const MarkerDictionary& dictionary);

  /// The nearest pattern, where no more bits differ than the dictionary corrects. Some 10 us for a thousand
  /// patterns.
  [[nodiscard]] std::optional<ReadCode> find(std::uint64_t bits) const;

 private:
  int bits_per_side_;
  int corrected_bits_;
  std::vector<std::uint64_t> codes_;
};

}  // namespace waymark::markers
