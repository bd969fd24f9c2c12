#pragma once

#include <chrono>

#include "waymark/core/stamp.hpp"

namespace waymark::app {

/// Of a clock that only goes forward.
[[nodiscard]] inline Duration wall_time() { return std::chrono::steady_clock::now().time_since_epoch(); }

}  // namespace waymark::app
