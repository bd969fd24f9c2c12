#include "workbench/logs/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace waymark {
namespace {

constexpr int kDecimals = 9;
constexpr std::uint64_t kBillion = 1'000'000'000;

void append_billionths(std::string& text, std::int64_t count) {
  const auto magnitude =
      count < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(count) : static_cast<std::uint64_t>(count);
  if (count < 0) text += '-';
  append_integer(text, static_cast<std::int64_t>(magnitude / kBillion));
  std::array<char, kDecimals> digits;
  std::uint64_t rest = magnitude % kBillion;
  for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit, rest /= 10)
    *digit = static_cast<char>('0' + rest % 10);
  text += '.';
  text.append(digits.data(), digits.size());
}

}  // namespace

void append_shortest(std::string& text, double value) {
  std::array<char, 32> buffer;
  text.append(buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr);
}

void append_integer(std::string& text, std::int64_t value) {
  std::array<char, 24> buffer;
  text.append(buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr);
}

void append_fixed(std::string& text, double value) {
  if (std::abs(value) < 9e9)
    return append_billionths(text, std::llround(value * static_cast<double>(kBillion)));
  std::array<char, 400> buffer;  // the largest double has 309 digits before the point
  text.append(buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                           std::chars_format::fixed, kDecimals)
                                 .ptr);
}

void append_stamp(std::string& text, Stamp stamp) { append_billionths(text, stamp.since_epoch.count()); }

}  // namespace waymark
