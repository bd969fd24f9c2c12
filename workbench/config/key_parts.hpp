#pragma once

#include <string_view>

namespace waymark {

/// "section." of the name of a key, "" where it has none.
[[nodiscard]] constexpr std::string_view section_of(std::string_view key) {
  return key.substr(0, key.find('.') + 1);  // npos + 1 is 0
}

/// The name of a key behind its last dot, all of it where it has none.
[[nodiscard]] constexpr std::string_view last_part(std::string_view key) {
  return key.substr(key.rfind('.') + 1);
}

}  // namespace waymark
