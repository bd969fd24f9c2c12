#pragma once

#include <cstdint>
#include <string>

#include "waymark/core/stamp.hpp"

namespace waymark {

/// Appends the shortest text that reads back as the same bits.
void append_shortest(std::string& text, double value);

void append_integer(std::string& text, std::int64_t value);

/// Appends with nine decimals, rounded to nearest, never "-0.000000000". About 15 ns below 9e9.
void append_fixed(std::string& text, double value);

/// Appends decimal seconds with nine decimals, exactly.
void append_stamp(std::string& text, Stamp stamp);

}  // namespace waymark
