#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace waymark::bag {

template <class T>
concept Number = std::integral<T> || std::floating_point<T>;

/// The number that begins at `bytes`, which needs no alignment.
template <Number T>
[[nodiscard]] T load(const char* bytes, std::endian order = std::endian::little) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes, sizeof(T));
  if (order != std::endian::native) std::ranges::reverse(raw);
  return std::bit_cast<T>(raw);
}

/// Takes little-endian numbers and pieces off the front of some bytes. What would go past the end reads as 0
/// or as nothing, and so does all that comes after it; ok() says so.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }

  template <Number T>
  T number() {
    const std::string_view raw = take(sizeof(T));
    return raw.size() == sizeof(T) ? load<T>(raw.data()) : T{};
  }

  std::string_view take(std::uint64_t count) {
    if (count > bytes_.size()) {
      ok_ = false;
      bytes_ = {};
      return {};
    }
    const std::string_view piece = bytes_.substr(0, static_cast<std::size_t>(count));
    bytes_.remove_prefix(piece.size());
    return piece;
  }

  /// A piece with its length before it.
  template <std::unsigned_integral Length = std::uint32_t>
  std::string_view counted() {
    return take(number<Length>());
  }

 private:
  std::string_view bytes_;
  bool ok_ = true;
};

}  // namespace waymark::bag
