#pragma once

#include <optional>
#include <string>
#include <vector>

#include "waymark/core/map_state.hpp"
#include "waymark/core/result.hpp"
#include "waymark/core/trajectory.hpp"

#include "workbench/eval/evaluate.hpp"
#include "workbench/logs/trajectory_file.hpp"
#include "workbench/run/config.hpp"

namespace waymark::app {

/// What is to be scored: a folder that `run` wrote with its map, a trajectory file, or the odometry of a log.
struct EvalResult {
  std::optional<TrajectoryFile> file;  ///< a path in space
  Trajectory trajectory;               ///< else
  std::vector<LandmarkEstimate> map;
  std::vector<std::string> notes;  ///< what was chosen
};

[[nodiscard]] Result<EvalResult> read_eval_result(const std::string& input, const UserSettings& user);

/// The reference: a log with ground truth, a trajectory file, or a folder that `run` wrote.
struct EvalTruth {
  std::optional<TrajectoryFile> file;  ///< a path in space
  eval::TruthTrack track;              ///< else
  std::vector<TrueLandmark> landmarks;
  eval::EvaluateOptions options;
  std::vector<std::string> notes;
};

[[nodiscard]] Result<EvalTruth> read_eval_truth(const std::string& input, const UserSettings& user);

}  // namespace waymark::app
