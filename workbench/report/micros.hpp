#pragma once

#include "waymark/core/stamp.hpp"

namespace waymark {

/// Of the processor, in which steps and blocks are reported.
[[nodiscard]] inline double micros(Duration d) { return 1e6 * to_seconds(d); }

}  // namespace waymark
