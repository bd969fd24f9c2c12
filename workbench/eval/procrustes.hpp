#pragma once

#include <optional>
#include <span>

#include "workbench/eval/associate.hpp"
#include "workbench/eval/map_error.hpp"

namespace waymark::eval {

/// A run under a similarity that is fitted on its landmarks and then applied to its path, as some
/// publications score. Kept for comparison with them: the free scale hides biased ranges and wheels, and a
/// turn fitted on a few landmarks swings the path (docs/evaluation.md).
struct ProcrustesScore {
  double scale = 1.0;                     ///< true size over estimated size
  double landmark_rmse_m = 0.0;           ///< what the fit leaves
  std::optional<double> position_rmse_m;  ///< of the path under the same similarity
};

/// Nothing below three landmarks. O(n).
[[nodiscard]] std::optional<ProcrustesScore> procrustes_score(std::span<const PosePair> pairs,
                                                              const MatchedPlaces& landmarks);

}  // namespace waymark::eval
