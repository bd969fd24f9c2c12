#pragma once

#include <optional>
#include <span>

#include "workbench/eval/associate.hpp"

namespace waymark::eval {

/// What the rotation of an anchor rests on.
enum class AnchorHeading {
  kTruth,  ///< the true heading at the first pair
  kPath,   ///< the direction of the first metre of the true path, for want of a heading
  kNone,   ///< nothing: no heading and no metre of path; the frames are taken as parallel
};

/// Puts an estimate into the frame of the truth by its start alone: the error of what follows shows in full.
struct StartAlignment {
  Pose2 T_truth_estimate;
  AnchorHeading heading = AnchorHeading::kNone;
};

/// The rigid motion that puts the first estimate onto the first truth; nothing without pairs.
[[nodiscard]] std::optional<StartAlignment> anchor_at_start(std::span<const PosePair> pairs);

/// How an estimate's path lies on the true one as a whole: fitted on the path, and then used for the map too
/// (a fit on landmarks would let a good map excuse a bad path, and the other way round).
struct PathFit {
  Pose2 T_truth_estimate;       ///< least squares over all positions
  std::optional<double> scale;  ///< diagnostic only: true size over estimated size, see `fitted_scale`
};

/// Nothing below three pairs, where a fit says little. O(n).
[[nodiscard]] std::optional<PathFit> fit_path(std::span<const PosePair> pairs);

}  // namespace waymark::eval
