#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "waymark/eval/evaluate.hpp"
#include "waymark/report/metrics.hpp"
#include "waymark/slam/config.hpp"
#include "waymark/slam/recording.hpp"

namespace waymark {

/// One run with everything that is known about it.
struct RunResult {
  std::string input;
  Config config;
  LogInfo log;
  Recording recording;
  eval::TruthTrack truth;
  std::optional<eval::Evaluation> evaluation;  ///< where the log has ground truth for path or map
  Metrics metrics;
};

/// Opens an input, runs the filter over it and scores the result. A log that breaks off half-way gives what
/// was computed up to there, with `recording.error` set.
[[nodiscard]] Result<RunResult> run_log(const std::string& input, const UserSettings& user,
                                        const TimeSpan& span = {},
                                        const std::function<bool(double)>& keep_going = {});

/// Writes trajectory.tum, trajectory_covariance.csv, map.csv, map.waymark, config.yaml, metrics.json and
/// report.html into `folder`.
/// `command` is what the report says it came from.
[[nodiscard]] Result<void> write_results(const RunResult& result, const std::filesystem::path& folder,
                                         const std::string& command);

}  // namespace waymark
