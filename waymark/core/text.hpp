#pragma once

#include <concepts>
#include <string>
#include <string_view>

#include "waymark/core/text.hpp"

namespace waymark {

/// "0.5" of (0.5, 1): with so many digits behind the point, rounded, whatever the locale.
[[nodiscard]] std::string decimals(double value, int digits);

/// Strings and whole numbers one after the other, for messages: the engine needs no formatting library.
template <class... Parts>
[[nodiscard]] std::string concat(const Parts&... parts) {
  std::string all;
  [[maybe_unused]] const auto append = [&all]<class Part>(const Part& part) {
    if constexpr (std::integral<Part>)
      all += std::to_string(part);
    else
      all += std::string_view(part);
  };
  (append(parts), ...);
  return all;
}

}  // namespace waymark
