#include "workbench/logs/used_bits.hpp"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

namespace waymark {

int UsedBits::shift(std::uint16_t largest) {
  largest_ = std::max(largest_, largest);
  const int needed = std::max(static_cast<int>(std::bit_width(largest_)), 8);
  bits_ = needed + needed % 2;
  return bits_ - 8;
}

std::string UsedBits::note() const {
  if (bits_ == 0 || bits_ == 16) return "";
  return fmt::format("uses {} of 16 bits (largest value {})", bits_, largest_);
}

}  // namespace waymark
