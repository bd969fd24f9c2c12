#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "workbench/study/tune_problem.hpp"

namespace waymark::study {

/// How well the optimum determines one key, in the search.
struct KeyFlatness {
  double low = 0.0;  ///< of the interval below
  double high = 0.0;
  bool open_low = false;  ///< it does not end there: the key's limit, or three decades, came first
  bool open_high = false;
  /// Points (place, value less that of the optimum) along the key with the others as they are, in order.
  std::vector<std::pair<double, double>> slice;
};

struct Flatness {
  std::vector<KeyFlatness> keys;
  TunePoint best;       ///< the best point that was looked at: the optimum, or one beside it
  double gained = 0.0;  ///< of that over the optimum
};

/// How flat the value is around an optimum. Along each key it is followed, on both sides, to where it has
/// fallen by 2 (for a likelihood: two standard deviations of a Gaussian). A quadratic through these points
/// and those of every pair of keys then tells how much farther that is if all the other keys follow: by
/// sqrt(H^-1_ii H_ii).
///
/// Observations that come from one pose of the robot are not independent, though the likelihood takes them
/// for that. So the interval is widened by sqrt(V_ii / H^-1_ii), V = H^-1 J H^-1, where it is more than 1
/// (Godambe 1960; White 1982): J is the covariance of the slope, estimated from the slopes of the kTuneBlocks
/// blocks of each log.
///
/// 2 p (p - 1) / 2 runs over all logs for p keys, and about 6 per key. Nothing if `keep_going` said no.
[[nodiscard]] std::optional<Flatness> find_flatness(const TuneProblem& problem, const TunePoint& optimum,
                                                    int threads, const TuneLog::KeepGoing& keep_going);

}  // namespace waymark::study
