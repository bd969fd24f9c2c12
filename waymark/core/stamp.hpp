#pragma once

#include <chrono>
#include <compare>
#include <optional>
#include <string>
#include <string_view>

namespace waymark {

using Duration = std::chrono::nanoseconds;

/// A point in time, counted from the epoch of its log (Unix time or the log's first row).
struct Stamp {
  Duration since_epoch{0};

  friend auto operator<=>(const Stamp&, const Stamp&) = default;
  friend Duration operator-(Stamp a, Stamp b) { return a.since_epoch - b.since_epoch; }
  friend Stamp operator+(Stamp a, Duration d) { return {a.since_epoch + d}; }
  friend Stamp operator-(Stamp a, Duration d) { return {a.since_epoch - d}; }
};

/// Seconds as a double, for arithmetic on differences and for display.
[[nodiscard]] inline double to_seconds(Duration d) { return std::chrono::duration<double>(d).count(); }
[[nodiscard]] inline double to_seconds(Stamp s) { return to_seconds(s.since_epoch); }

/// Nearest nanosecond. |seconds| must be below 9e9 (285 years).
[[nodiscard]] Duration duration_from_seconds(double seconds);
[[nodiscard]] Stamp stamp_from_seconds(double seconds);

/// Reads decimal seconds such as "1248444175.103" exactly (a double would lose the last digits of a
/// Unix stamp). Nine decimals count, further ones are cut off; exponents are accepted through a double.
/// Empty: not a finite number, something before or after it, or 9e9 s and more (stamps in ns or ms, say).
[[nodiscard]] std::optional<Stamp> parse_stamp(std::string_view text);

/// Decimal seconds with nine decimals, the inverse of `parse_stamp` to the last nanosecond below 9e9 s.
[[nodiscard]] std::string to_string(Stamp stamp);

}  // namespace waymark
