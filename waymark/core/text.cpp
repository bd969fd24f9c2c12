#include "waymark/core/text.hpp"

#include <array>
#include <charconv>

namespace waymark {

std::string decimals(double value, int digits) {
  std::array<char, 400> buffer;  // the largest double has 309 digits before the point
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, digits);
  return {buffer.data(), end.ec == std::errc() ? end.ptr : buffer.data()};
}

}  // namespace waymark
