#pragma once

#include <cstddef>

namespace waymark {

/// A place in a container, of an int that is not below 0.
[[nodiscard]] constexpr std::size_t as_index(int i) { return static_cast<std::size_t>(i); }

}  // namespace waymark
