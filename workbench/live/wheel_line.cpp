#include "workbench/live/wheel_line.hpp"

#include <charconv>
#include <cstddef>
#include <numbers>

#include <fmt/format.h>

#include "workbench/logs/text_lines.hpp"

namespace waymark::live {
namespace {

constexpr std::size_t kLongest = 64;

std::uint8_t checksum(std::string_view text) {
  std::uint8_t sum = 0;
  for (const char c : text) sum ^= static_cast<std::uint8_t>(c);
  return sum;
}

template <class Number>
bool read_word(std::string_view& rest, Number& number, int base = 10) {
  const std::string_view word = take_word(rest);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number, base);
  return error == std::errc{} && end == word.data() + word.size();
}

}  // namespace

std::optional<WheelLine> parse_wheel_line(std::string_view line) {
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
  const std::size_t star = line.rfind('*');
  if (line.size() > kLongest || star == std::string_view::npos || !line.starts_with("E "))
    return std::nullopt;
  std::string_view sum_text = line.substr(star + 1);
  unsigned int sum = 0;
  if (sum_text.size() != 2 || !read_word(sum_text, sum, 16) || sum != checksum(line.substr(0, star)))
    return std::nullopt;
  std::string_view rest = line.substr(2, star - 2);
  WheelLine read;
  if (!read_word(rest, read.sequence) || !read_word(rest, read.clock_ms) ||
      !read_word(rest, read.left_ticks) || !read_word(rest, read.right_ticks) || !take_word(rest).empty())
    return std::nullopt;
  return read;
}

std::string to_string(const WheelLine& line) {
  const std::string text =
      fmt::format("E {} {} {} {}", line.sequence, line.clock_ms, line.left_ticks, line.right_ticks);
  return fmt::format("{}*{:02X}", text, checksum(text));
}

WheelCounter::WheelCounter(double ticks_per_turn) : rad_per_tick_(2.0 * std::numbers::pi / ticks_per_turn) {}

/// Differences of unsigned numbers are right where these wrap.
WheelCounter::Reading WheelCounter::add(const WheelLine& line) {
  Reading reading;
  if (last_) {
    const auto difference = [](std::int32_t now, std::int32_t before) {
      return static_cast<std::int32_t>(static_cast<std::uint32_t>(now) - static_cast<std::uint32_t>(before));
    };
    const std::uint32_t skipped = line.sequence - last_->sequence - 1;
    const bool began_anew = skipped > 1'000'000;
    reading.lost = began_anew ? 0 : skipped;
    clock_ms_ += began_anew ? line.clock_ms : line.clock_ms - last_->clock_ms;
    left_ticks_ += difference(line.left_ticks, last_->left_ticks);
    right_ticks_ += difference(line.right_ticks, last_->right_ticks);
  }
  last_ = line;
  reading.clock = std::chrono::milliseconds(clock_ms_);
  reading.angles = {static_cast<double>(left_ticks_) * rad_per_tick_,
                    static_cast<double>(right_ticks_) * rad_per_tick_};
  return reading;
}

}  // namespace waymark::live
