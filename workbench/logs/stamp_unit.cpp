#include "workbench/logs/stamp_unit.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

namespace waymark {
namespace {

constexpr std::array<std::string_view, 4> kNames{"seconds", "milliseconds", "microseconds", "nanoseconds"};

/// Between the seconds of the year 1970 + 285 and the milliseconds of 1973, and so on in steps of a thousand.
constexpr double kMilliseconds = 1e11, kMicroseconds = 1e14, kNanoseconds = 1e17;
constexpr double kTooManySeconds = 9e9;  // parse_stamp()

/// Time since 1970 in seconds is at least this, from the year 2001 on.
constexpr double kUnixSeconds = 1e9;
/// Of the time since 1970, that a log may last: years, where nanoseconds grow twice as large in seconds.
constexpr double kLongestPart = 0.1;

double median_step(std::span<const double> counts) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < counts.size(); ++i)
    if (counts[i] != counts[i - 1]) steps.push_back(counts[i] - counts[i - 1]);
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + std::ssize(steps) / 2;
  std::ranges::nth_element(steps, middle);
  return *middle;
}

bool is_plain_decimal(std::string_view text) {
  if (text.starts_with('-')) text.remove_prefix(1);
  return !text.empty() && text.find_first_not_of("0123456789.") == std::string_view::npos;
}

/// The decimal point so many places further left.
std::string shifted(std::string_view text, int places) {
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  const std::size_t dot = std::min(text.find('.'), text.size());
  std::string digits(text.substr(0, dot));
  if (const auto width = static_cast<std::size_t>(places) + 1; digits.size() < width)
    digits.insert(0, width - digits.size(), '0');
  digits.insert(digits.size() - static_cast<std::size_t>(places), ".");
  if (dot < text.size()) digits += text.substr(dot + 1);
  return negative ? '-' + digits : digits;
}

}  // namespace

std::string_view name_of(StampUnit unit) { return kNames[static_cast<std::size_t>(unit)]; }

int places_of(StampUnit unit) { return 3 * static_cast<int>(unit); }

std::optional<StampUnit> unit_of_large_stamp(double count) {
  const double size = std::abs(count);
  if (size < kTooManySeconds) return std::nullopt;
  if (size >= kNanoseconds || size < kMilliseconds) return StampUnit::kNanoseconds;
  return size >= kMicroseconds ? StampUnit::kMicroseconds : StampUnit::kMilliseconds;
}

StampUnit unit_of(std::span<const double> counts) {
  if (counts.empty()) return StampUnit::kSeconds;
  const double first = std::abs(counts.front());
  if (first >= kMilliseconds) return *unit_of_large_stamp(first);
  const bool is_whole = std::ranges::all_of(counts, [](double count) { return count == std::trunc(count); });
  const bool is_unix = first >= kUnixSeconds && first < kTooManySeconds &&
                       std::abs(counts.back() - counts.front()) < kLongestPart * first;
  if (!is_whole || is_unix) return StampUnit::kSeconds;
  const double step = median_step(counts);
  if (step < 10.0) return StampUnit::kSeconds;
  if (step < 1e3) return StampUnit::kMilliseconds;
  return step < 1e6 ? StampUnit::kMicroseconds : StampUnit::kNanoseconds;
}

std::optional<Stamp> parse_stamp(std::string_view text, StampUnit unit) {
  if (unit == StampUnit::kSeconds) return parse_stamp(text);
  if (is_plain_decimal(text)) return parse_stamp(shifted(text, places_of(unit)));
  double count = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  const double seconds = count * std::pow(10.0, -places_of(unit));
  if (error != std::errc{} || end != text.data() + text.size() || !(std::abs(seconds) < kTooManySeconds))
    return std::nullopt;
  return stamp_from_seconds(seconds);
}

}  // namespace waymark
