#pragma once

#include "waymark/core/stamp.hpp"

namespace waymark::test {

inline Stamp at(double seconds) { return stamp_from_seconds(seconds); }

}  // namespace waymark::test
