#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "waymark/core/result.hpp"

namespace waymark::study {

/// A config key and the values that it takes in a sweep, as text.
struct Axis {
  std::string key;
  std::vector<std::string> values;
};

/// Reads "KEY=VALUE,VALUE,..." where a value may also be a span of whole numbers, "1..20". Every value has
/// been accepted by the config; an unknown key is refused with those that are close to it.
[[nodiscard]] Result<Axis> parse_axis(std::string_view text);

}  // namespace waymark::study
