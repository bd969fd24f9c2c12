#include "waymark/core/stamp.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace waymark {
namespace {

constexpr double kMaxSeconds = 9.0e9;
constexpr std::int64_t kNanosPerSecond = 1'000'000'000;

bool is_digits(std::string_view text) {
  return text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// "103" -> 103 000 000 ns; digits beyond the ninth are below the resolution of a stamp.
std::int64_t fraction_to_nanos(std::string_view digits) {
  std::int64_t nanos = 0;
  for (std::size_t i = 0; i < 9; ++i) nanos = nanos * 10 + (i < digits.size() ? digits[i] - '0' : 0);
  return nanos;
}

std::optional<Stamp> parse_plain_decimal(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  const std::size_t dot = text.find('.');
  const std::string_view whole = text.substr(0, dot);
  const std::string_view fraction = dot == std::string_view::npos ? "" : text.substr(dot + 1);
  if (whole.size() + fraction.size() == 0 || whole.size() > 9 + 1 || !is_digits(whole) ||
      !is_digits(fraction))
    return std::nullopt;
  std::int64_t seconds = 0;
  std::from_chars(whole.data(), whole.data() + whole.size(), seconds);
  if (static_cast<double>(seconds) >= kMaxSeconds) return std::nullopt;
  const std::int64_t nanos = seconds * kNanosPerSecond + fraction_to_nanos(fraction);
  return Stamp{Duration{negative ? -nanos : nanos}};
}

}  // namespace

Duration duration_from_seconds(double seconds) {
  return Duration{std::llround(seconds * static_cast<double>(kNanosPerSecond))};
}

Stamp stamp_from_seconds(double seconds) { return {duration_from_seconds(seconds)}; }

std::optional<Stamp> parse_stamp(std::string_view text) {
  if (const auto exact = parse_plain_decimal(text)) return exact;
  double seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc{} || end != text.data() + text.size() || !(std::abs(seconds) < kMaxSeconds))
    return std::nullopt;
  return stamp_from_seconds(seconds);
}

std::string to_string(Stamp stamp) {
  const std::int64_t nanos = stamp.since_epoch.count();
  const auto magnitude =
      nanos < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(nanos) : static_cast<std::uint64_t>(nanos);
  char text[40];
  const int length = std::snprintf(text, sizeof text, "%s%llu.%09llu", nanos < 0 ? "-" : "",
                                   static_cast<unsigned long long>(magnitude / kNanosPerSecond),
                                   static_cast<unsigned long long>(magnitude % kNanosPerSecond));
  return {text, static_cast<std::size_t>(length)};
}

}  // namespace waymark
