#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "waymark/core/event.hpp"

namespace waymark::live {

/// A line of the wheels' serial protocol, which firmware/ speaks:
///
///     E <sequence> <ms> <left> <right>*<XX>
///
/// with the number of the line, the board's clock in ms, both encoders' counts, and the exclusive or of all
/// characters before the `*` in hexadecimal. Number and clock wrap at 2^32, counts at 2^31.
struct WheelLine {
  std::uint32_t sequence = 0;
  std::uint32_t clock_ms = 0;
  std::int32_t left_ticks = 0;
  std::int32_t right_ticks = 0;

  friend bool operator==(const WheelLine&, const WheelLine&) = default;
};

/// Nothing where the line is not one of these, or its checksum is wrong.
[[nodiscard]] std::optional<WheelLine> parse_wheel_line(std::string_view line);

/// Without an end of line.
[[nodiscard]] std::string to_string(const WheelLine& line);

/// Follows what wraps in successive lines.
class WheelCounter {
 public:
  explicit WheelCounter(double ticks_per_turn);

  struct Reading {
    Duration clock;  ///< of the board, since its first line
    WheelAngles angles;
    std::uint32_t lost = 0;  ///< lines before this one; 0 where the board began anew
  };
  [[nodiscard]] Reading add(const WheelLine& line);

 private:
  double rad_per_tick_;
  std::optional<WheelLine> last_;
  std::int64_t clock_ms_ = 0;
  std::int64_t left_ticks_ = 0;
  std::int64_t right_ticks_ = 0;
};

}  // namespace waymark::live
