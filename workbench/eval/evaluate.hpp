#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "waymark/core/map_state.hpp"
#include "waymark/core/trajectory.hpp"

#include "workbench/eval/associate.hpp"
#include "workbench/eval/map_error.hpp"
#include "workbench/eval/path_alignment.hpp"
#include "workbench/eval/procrustes.hpp"
#include "workbench/eval/trajectory_error.hpp"
#include "workbench/eval/truth_track.hpp"
#include "workbench/logs/source.hpp"

namespace waymark::eval {

/// Errors of one path. Anchored: placed by its true start pose alone; aligned: one least-squares rigid
/// motion.
struct PathScore {
  std::optional<double> position_rmse_m;          ///< anchored
  std::optional<double> position_rmse_aligned_m;  ///< aligned
  std::optional<double> heading_rmse_deg;         ///< anchored
  std::optional<double> final_error_m;            ///< anchored, at the last pair
};

/// What a run is worth against ground truth. Whatever the truth does not allow is empty.
struct Evaluation {
  std::size_t truth_samples = 0;  ///< all of the truth
  std::size_t pairs = 0;          ///< of them inside the run: what is scored
  double scored_s = 0.0;          ///< from the first pair to the last
  std::optional<double> path_m;   ///< length of the true path that is scored

  PathScore path;                             ///< the estimate
  PathScore odometry;                         ///< dead reckoning alone
  NeesSummary nees;                           ///< pose, anchored
  std::optional<MapError> map;                ///< landmarks
  std::optional<ProcrustesScore> procrustes;  ///< what another habit of scoring would say
  std::vector<RelativeError> relative;  ///< drift over 1, 5, 10 and 20 m, where the truth is long enough

  std::optional<StartAlignment> anchor;  ///< T_truth_estimate at the start
  std::optional<PathFit> fit;       ///< T_truth_estimate by least squares, with the scale as a diagnostic
  std::vector<ErrorSample> series;  ///< anchored errors over time
  std::vector<std::string> notes;   ///< what a reader of the figures must know
};

struct EvaluateOptions {
  AssociateOptions associate;
  LandmarkNames names = LandmarkNames::kAuto;
};

inline constexpr std::array kRelativeDistancesM{1.0, 5.0, 10.0, 20.0};

/// Scores a path and a map. `dead_reckoning` may be empty, as may any other argument. Trajectories are in
/// order of time. O(n + m) in poses and truth samples.
[[nodiscard]] Evaluation evaluate(const Trajectory& estimate, std::span<const LandmarkEstimate> map,
                                  const TruthTrack& truth, std::span<const TrueLandmark> survey,
                                  const Trajectory& dead_reckoning = {}, const EvaluateOptions& options = {});

/// Scores a path alone (dead reckoning, a smoothed path).
[[nodiscard]] PathScore score_path(const Trajectory& estimate, const TruthTrack& truth,
                                   const AssociateOptions& options = {});

}  // namespace waymark::eval
