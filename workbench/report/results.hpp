#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "workbench/report/metrics.hpp"
#include "workbench/study/scored_run.hpp"

namespace waymark {

/// One run with everything that is known about it.
struct RunResult : study::ScoredRun {
  Metrics metrics;
};

/// study::run_and_score() with its metrics.
[[nodiscard]] Result<RunResult> run_log(const std::string& input, const UserSettings& user,
                                        const TimeSpan& span = {},
                                        const std::function<bool(double)>& keep_going = {});

/// Writes trajectory.tum, trajectory_covariance.csv, map.csv, map.waymark, config.yaml, metrics.json and
/// report.html into `folder`; of a smoothed run trajectory_smoothed.tum and map_smoothed.csv, too, and
/// calibration.yaml where one was estimated.
/// `command` is what the report says it came from. A session has written its trajectory already.
[[nodiscard]] Result<void> write_results(const RunResult& result, const std::filesystem::path& folder,
                                         const std::string& command, bool with_trajectory = true);

}  // namespace waymark
