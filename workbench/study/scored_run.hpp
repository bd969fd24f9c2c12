#pragma once

#include <functional>
#include <optional>
#include <string>

#include "workbench/eval/evaluate.hpp"
#include "workbench/run/config.hpp"
#include "workbench/run/recording.hpp"
#include "workbench/run/smoother.hpp"

namespace waymark::study {

/// One run over a log, scored against the log's ground truth.
struct ScoredRun {
  std::string input;
  Config config;
  LogInfo log;
  Recording recording;
  eval::TruthTrack truth;
  std::optional<eval::Evaluation> evaluation;  ///< where the log has ground truth for path or map
  std::optional<smooth::Smoothed> smoothed;    ///< where smooth.run asks for it
  std::optional<eval::Evaluation> smoothed_evaluation;
};

/// A run that has been made, scored.
[[nodiscard]] ScoredRun score_run(std::string input, Config config, LogInfo log, Recording recording);

/// Opens an input, runs the filter over it and scores the result. A log that breaks off half-way gives what
/// was computed up to there, with `recording.error` set. `keep_going` as in record().
[[nodiscard]] Result<ScoredRun> run_and_score(const std::string& input, const UserSettings& user,
                                              const TimeSpan& span = {},
                                              const std::function<bool(double)>& keep_going = {});

}  // namespace waymark::study
