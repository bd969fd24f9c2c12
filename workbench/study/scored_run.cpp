#include "workbench/study/scored_run.hpp"

#include <utility>
#include <vector>

namespace waymark::study {
namespace {

eval::TruthTrack truth_of(const Recording& recording) {
  std::vector<eval::TruthSample> samples;
  for (const auto& [stamp, truth] : recording.truth) samples.push_back({stamp, truth});
  return eval::TruthTrack(std::move(samples));
}

/// Nothing where the log has no ground truth.
std::optional<eval::Evaluation> score(const ScoredRun& run, const Trajectory& trajectory,
                                      const std::vector<LandmarkEstimate>& map) {
  if (run.truth.empty() && run.log.landmarks.empty()) return std::nullopt;
  eval::EvaluateOptions options;
  if (run.log.truth_sensor_m) options.associate.truth_sensor_m = *run.log.truth_sensor_m;
  return eval::evaluate(trajectory, map, run.truth, run.log.landmarks, run.recording.dead_reckoning, options);
}

/// A run that cannot be smoothed keeps why in its notes.
void smooth_run(ScoredRun& run) {
  auto smoothed = smooth::smooth(run.recording, run.config);
  if (!smoothed) {
    run.recording.notes.push_back(smoothed.error().message);
    return;
  }
  run.smoothed_evaluation = score(run, smoothed->trajectory, smoothed->landmarks);
  run.smoothed = *std::move(smoothed);
}

}  // namespace

ScoredRun score_run(std::string input, Config config, LogInfo log, Recording recording) {
  ScoredRun run{std::move(input), std::move(config), std::move(log), std::move(recording), {}, {}, {}, {}};
  run.truth = truth_of(run.recording);
  run.evaluation = score(run, run.recording.trajectory, run.recording.filter->snapshot().landmarks);
  return run;
}

Result<ScoredRun> run_and_score(const std::string& input, const UserSettings& user, const TimeSpan& span,
                                const std::function<bool(double)>& keep_going) {
  auto opened = open_input(input, user);
  if (!opened) return opened.error();
  auto recording = record(*opened->source, opened->config, span, keep_going);
  if (!recording) return recording.error();
  const LogInfo& log = opened->source->info();
  const std::string& name =
      opened->source->replay() ? log.name : input;  // the session, whose result it is again
  ScoredRun run = score_run(name, opened->config, log, *std::move(recording));
  if (run.config.smooth.run) smooth_run(run);
  return run;
}

}  // namespace waymark::study
