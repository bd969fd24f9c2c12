#pragma once

#include <cstdint>

namespace waymark::vision {

/// What happened since the tracker was made.
struct TrackerCounts {
  std::int64_t images = 0;
  std::int64_t unusable = 0;       ///< images that showed nothing, or were of another size
  std::int64_t out_of_budget = 0;  ///< images in which something was left out for want of time
};

}  // namespace waymark::vision
