#include <cstdio>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "workbench/eval/evaluate.hpp"
#include "workbench/logs/map_files.hpp"
#include "workbench/logs/pose_covariances.hpp"
#include "workbench/logs/tum.hpp"
#include "workbench/report/metrics.hpp"

namespace waymark::app {
namespace {

namespace fs = std::filesystem;

struct EvalRequest {
  std::string result;
  std::string truth;
  SettingsFlags flags;
  Verbosity verbosity;
};

/// What is to be scored: a results folder with its map, or a bare trajectory.
struct Estimate {
  Trajectory trajectory;
  std::vector<LandmarkEstimate> map;
};

/// The landmarks of map.csv under the full ids of map.waymark: of an id the table has the number only.
Result<std::vector<LandmarkEstimate>> read_landmarks(const fs::path& folder) {
  auto landmarks = read_map_csv(folder / "map.csv");
  if (!landmarks || !fs::exists(folder / "map.waymark")) return landmarks;
  const auto map = read_map(folder / "map.waymark");
  if (!map) return map.error();
  if (map->ids.size() != landmarks->size()) return landmarks;
  for (std::size_t i = 0; i < landmarks->size(); ++i) (*landmarks)[i].id = map->ids[i];
  return landmarks;
}

Result<Estimate> read_estimate(const fs::path& path) {
  const bool folder = fs::is_directory(path);
  if (folder && !fs::exists(path / "trajectory.tum"))
    return Error{path.string() + " is not a folder that `waymark run` wrote (no trajectory.tum)"};
  auto trajectory = read_tum(folder ? path / "trajectory.tum" : path);
  if (!trajectory) return trajectory.error();
  Estimate estimate{std::move(*trajectory), {}};
  const fs::path covariances = path / "trajectory_covariance.csv";
  if (folder && fs::exists(covariances))
    if (auto done = read_pose_covariances(covariances, estimate.trajectory); !done) return done.error();
  if (!folder || !fs::exists(path / "map.csv")) return estimate;
  auto map = read_landmarks(path);
  if (!map) return map.error();
  estimate.map = std::move(*map);
  return estimate;
}

/// The reference: a log of any format, or a TUM trajectory.
struct Reference {
  eval::TruthTrack track;
  std::vector<TrueLandmark> landmarks;
  eval::EvaluateOptions options;
};

Result<Reference> read_log_truth(const std::string& input, const UserSettings& user) {
  auto opened = open_input(input, user);
  if (!opened) return opened.error();
  Reference reference;
  std::vector<eval::TruthSample> samples;
  while (true) {
    auto event = opened->source->next();
    if (!event) return event.error();
    if (!*event) break;
    if (const auto* truth = std::get_if<Truth>(&(*event)->content))
      samples.push_back({(*event)->stamp, *truth});
  }
  const LogInfo& log = opened->source->info();
  reference.track = eval::TruthTrack(std::move(samples));
  reference.landmarks = log.landmarks;
  if (log.truth_sensor_m) reference.options.associate.truth_sensor_m = *log.truth_sensor_m;
  return reference;
}

Result<Reference> read_reference(const std::string& input, const UserSettings& user) {
  if (!fs::is_regular_file(input)) return read_log_truth(input, user);
  auto trajectory = read_tum(input);
  if (!trajectory) return trajectory.error();
  return Reference{eval::TruthTrack::from_trajectory(*trajectory), {}, {}};
}

Result<void> evaluate(const EvalRequest& request) {
  auto estimate = read_estimate(request.result);
  if (!estimate) return estimate.error();
  auto reference = read_reference(request.truth, request.flags.settings());
  if (!reference) return reference.error();
  if (reference->track.empty() && reference->landmarks.empty())
    return Error{request.truth +
                 ": no ground truth found: expected truth.csv or landmarks.csv, or a TUM trajectory"};
  const auto evaluation = eval::evaluate(estimate->trajectory, estimate->map, reference->track,
                                         reference->landmarks, {}, reference->options);
  if (evaluation.pairs == 0 && !reference->track.empty())
    return Error{fmt::format(
        "{}: does not overlap in time with {}: the estimate covers {} to {} s, the ground truth {} to {} s",
        request.result, request.truth, to_string(estimate->trajectory.front().stamp),
        to_string(estimate->trajectory.back().stamp), to_string(reference->track.samples().front().stamp),
        to_string(reference->track.samples().back().stamp))};
  fmt::print("{}", request.verbosity.json ? truth_json_text(evaluation) : to_text(evaluation));
  return {};
}

}  // namespace

void add_eval(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand(
      "eval", "Compute the errors of a result against ground truth, with and without alignment");
  auto request = std::make_shared<EvalRequest>();
  command->add_option("result", request->result, "folder that `waymark run` wrote, or a TUM trajectory")
      ->required()
      ->type_name("RESULT");
  command->add_option("--truth", request->truth, "log with ground truth, or a TUM trajectory")
      ->required()
      ->type_name("LOG_OR_FILE");
  request->flags.add_to(*command);
  command->add_flag("--json", request->verbosity.json,
                    "print the errors as JSON on standard output and nothing else there");
  command->footer(
      "Examples:\n  waymark eval out --truth LOG\n  waymark eval mine.tum --truth reference.tum --json");
  command->callback([&work, request] { work = [request] { return evaluate(*request); }; });
}

}  // namespace waymark::app
