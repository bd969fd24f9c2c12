#pragma once

#include <exception>

#include "waymark/core/result.hpp"

namespace waymark {

/// What was thrown while running, as an error: in words also where the exception only has a name.
[[nodiscard]] Error failure(const std::exception& problem);

}  // namespace waymark
