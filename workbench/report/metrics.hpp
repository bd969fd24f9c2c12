#pragma once

#include <optional>
#include <string>
#include <vector>

#include "waymark/core/function_blocks.hpp"

#include "workbench/eval/evaluate.hpp"
#include "workbench/run/recording.hpp"
#include "workbench/run/recording_figures.hpp"
#include "workbench/run/smoother.hpp"
#include "workbench/run/verdict.hpp"

namespace waymark {

/// What the whole log says, in figures.
struct SmoothedFigures {
  double cpu_s = 0.0;
  int iterations = 0;
  bool converged = false;
  std::size_t poses = 0;
  std::size_t observations = 0;
  std::vector<smooth::CalibratedKey> calibration;
  eval::Evaluation live;  ///< what the filter said live, scored against the smoothed path and map
  std::optional<eval::Evaluation> truth;  ///< the smoothed path and map, scored against the truth
};

/// One run in figures: what metrics.json holds.
struct Metrics {
  std::string input;
  std::string filter;
  std::string observe;
  std::string associate;
  std::uint64_t seed = 0;
  Verdict verdict;
  PoseLosses losses;
  Stamp start;  ///< of the log
  double duration_s = 0.0;
  std::int64_t events = 0;
  std::int64_t observations = 0;
  std::size_t landmarks = 0;
  double wall_s = 0.0;
  double realtime_factor = 0.0;
  StepTimes steps;
  std::vector<FunctionBlocks::Row> blocks;
  std::size_t frames = 0;  ///< steps with a correction
  std::int64_t deadline_misses = 0;
  double peak_rss_mb = 0.0;
  std::optional<double> nis_per_dof;  ///< over accepted observations; ideal 1
  std::optional<eval::Evaluation> truth;
  std::vector<smooth::CalibratedKey> calibration;  ///< that the filter estimated
  std::optional<SmoothedFigures> smoothed;
};

/// `wall_s` covers what the caller says: the run alone, or reading and evaluation with it.
[[nodiscard]] Metrics make_metrics(const std::string& input, const Config& config, const Recording& recording,
                                   const std::optional<eval::Evaluation>& truth);

/// metrics.json, keys in a fixed order. What is not known is left out.
[[nodiscard]] std::string to_json(const Metrics& metrics);

/// The figures of a run that was smoothed.
[[nodiscard]] SmoothedFigures smoothed_figures(const smooth::Smoothed& smoothed, const Config& config,
                                               const Recording& recording,
                                               const std::optional<eval::Evaluation>& truth);

/// The `truth` part of it alone.
[[nodiscard]] std::string truth_json_text(const eval::Evaluation& evaluation);

/// The same for people, a few lines.
[[nodiscard]] std::string to_text(const Metrics& metrics);
[[nodiscard]] std::string to_text(const eval::Evaluation& evaluation);

/// The largest memory that the process held so far, MB.
[[nodiscard]] double peak_rss_mb();

}  // namespace waymark
