#pragma once

namespace waymark::vision {

/// Where and when new landmarks are wanted.
struct NewCornerOptions {
  int wanted = 24;         ///< features in view: with fewer, new ones are searched for
  int max_candidates = 8;  ///< under way at a time
  int max_new = 4;         ///< in one image
};

}  // namespace waymark::vision
