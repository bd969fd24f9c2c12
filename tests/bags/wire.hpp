#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include "workbench/bags/reader.hpp"

namespace waymark::bag::test {

/// Writes values as ROS 1 or CDR have them.
class Wire {
 public:
  enum class Text { kString, kBytes };

  explicit Wire(Encoding encoding, std::endian order = std::endian::little)
      : is_cdr_(encoding == Encoding::kCdr), order_(order) {
    if (is_cdr_)
      bytes_ = std::string("\0", 1) + (order == std::endian::big ? '\0' : '\1') + std::string(2, '\0');
  }

  template <class T>
  Wire& add(T value) {
    while (is_cdr_ && (bytes_.size() - 4) % sizeof(T) != 0) bytes_ += '\0';
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (order_ != std::endian::native) std::ranges::reverse(raw);
    bytes_.append(raw.data(), raw.size());
    return *this;
  }

  Wire& text(std::string_view text, Text kind = Text::kString) {
    const bool has_end = is_cdr_ && kind == Text::kString;
    add(static_cast<std::uint32_t>(text.size() + (has_end ? 1 : 0)));
    bytes_ += text;
    if (has_end) bytes_ += '\0';
    return *this;
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  bool is_cdr_;
  std::endian order_;
  std::string bytes_;
};

}  // namespace waymark::bag::test
