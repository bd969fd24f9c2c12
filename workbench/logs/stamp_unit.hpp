#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "waymark/core/stamp.hpp"

namespace waymark {

/// What stamps of other programs count.
enum class StampUnit { kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };

/// "milliseconds".
[[nodiscard]] std::string_view name_of(StampUnit unit);

/// Decimal places from this unit to seconds: 3 for milliseconds.
[[nodiscard]] int places_of(StampUnit unit);

/// The unit of a stamp that cannot be in seconds, 9e9 and more: by the time since 1970 that it gives, and
/// below all of these nanoseconds since some start. Nothing for smaller ones, which may be seconds.
[[nodiscard]] std::optional<StampUnit> unit_of_large_stamp(double count);

/// The likely unit of the stamps of a path, in its order: by their size where that is of time since 1970,
/// else the one in which half of its rows follow one another within a second, or within 10 s where they may
/// be seconds. Whole numbers only: who counts seconds with decimals counts seconds. O(n log n).
[[nodiscard]] StampUnit unit_of(std::span<const double> counts);

/// A decimal number of units as a stamp, exact to the nanosecond; exponents are read through a double. Empty
/// as for parse_stamp().
[[nodiscard]] std::optional<Stamp> parse_stamp(std::string_view text, StampUnit unit);

}  // namespace waymark
