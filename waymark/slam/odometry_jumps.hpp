#pragma once

#include <optional>

#include "waymark/core/stamp.hpp"

namespace waymark {

/// How often something happened, and when first.
struct Occurrences {
  int count = 0;
  Stamp first;

  void add(Stamp stamp, int times = 1) {
    if (count == 0) first = stamp;
    count += times;
  }
};

/// What no robot can do, in the readings of its odometry.
struct OdometryJumps {
  Occurrences resets;    ///< the readings went on from elsewhere: a reset, or a counter that rolled over
  Occurrences outliers;  ///< readings left out: the ones behind them went on from the ones before them
  Occurrences wraps;     ///< wheel angles that went on one turn, or one range of a binary counter, away
};

}  // namespace waymark
