#include "waymark/study/scored_run.hpp"

#include <utility>
#include <vector>

namespace waymark::study {
namespace {

void score(ScoredRun& run) {
  std::vector<eval::TruthSample> samples;
  for (const auto& [stamp, truth] : run.recording.truth) samples.push_back({stamp, truth});
  run.truth = eval::TruthTrack(std::move(samples));
  if (run.truth.empty() && run.log.landmarks.empty()) return;
  eval::EvaluateOptions options;
  if (run.log.truth_sensor_m) options.associate.truth_sensor_m = *run.log.truth_sensor_m;
  const auto map = run.recording.filter->snapshot().landmarks;
  run.evaluation = eval::evaluate(run.recording.trajectory, map, run.truth, run.log.landmarks,
                                  run.recording.dead_reckoning, options);
}

}  // namespace

Result<ScoredRun> run_and_score(const std::string& input, const UserSettings& user, const TimeSpan& span,
                                const std::function<bool(double)>& keep_going) {
  auto opened = open_input(input, user);
  if (!opened) return opened.error();
  auto recording = record(*opened->source, opened->config, span, keep_going);
  if (!recording) return recording.error();
  ScoredRun run{input, opened->config, opened->source->info(), std::move(*recording), {}, {}};
  score(run);
  return run;
}

}  // namespace waymark::study
