#pragma once

#include <optional>

#include "waymark/core/trajectory.hpp"

#include "workbench/eval/associate.hpp"
#include "workbench/eval/truth_track.hpp"

namespace waymark::calibrate {

/// How far dead reckoning strays from a reference that starts at the same pose.
struct Drift {
  double path_m = 0.0;             ///< of the reference
  double final_m = 0.0;            ///< position at the end
  double final_heading_deg = 0.0;  ///< heading at the end, +-180; 0 where the reference has none
  double rmse_m = 0.0;             ///< of all positions
  double rmse_aligned_m = 0.0;     ///< after one rigid motion fitted on the whole path

  [[nodiscard]] double percent() const { return path_m > 0.0 ? 100.0 * final_m / path_m : 0.0; }
};

/// Nothing where the two have less than three moments in common.
[[nodiscard]] std::optional<Drift> drift_of(const Trajectory& dead_reckoning,
                                            const eval::TruthTrack& reference,
                                            const eval::AssociateOptions& options = {});

}  // namespace waymark::calibrate
