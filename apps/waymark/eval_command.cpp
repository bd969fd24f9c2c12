#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "commands.hpp"
#include "eval_inputs.hpp"
#include "workbench/eval/space_path.hpp"
#include "workbench/eval/space_score.hpp"
#include "workbench/report/metrics.hpp"

namespace waymark::app {
namespace {

struct EvalRequest {
  std::string result;
  std::string truth;
  std::string plane;
  SettingsFlags flags;
  Verbosity verbosity;
};

/// The plane that --plane asks for; empty: the paths say whether they have one.
using WantedPlane = std::optional<eval::Plane>;

/// The paths of both sides in space.
struct SpacePaths {
  SpacePath result;
  SpacePath truth;
};

SpacePaths paths_of(const EvalResult& result, const EvalTruth& truth) {
  return {result.file ? result.file->path : eval::in_space(result.trajectory),
          truth.file ? truth.file->path : eval::in_space(truth.track)};
}

/// Poses without stamps are matched by their number.
Result<void> check_stamps(const EvalRequest& request, const EvalResult& result, const EvalTruth& truth) {
  const bool result_has = !result.file || result.file->has_stamps;
  const bool truth_has = !truth.file || truth.file->has_stamps;
  if (result_has && truth_has) return {};
  if (result_has || truth_has)
    return Error{fmt::format(
        "{}: poses without stamps (KITTI) can be scored only against others without stamps, "
        "and {} has stamps; write both as TUM: stamp_s tx ty tz qx qy qz qw",
        result_has ? request.truth : request.result, result_has ? request.result : request.truth)};
  if (result.file->path.size() == truth.file->path.size()) return {};
  return Error{
      fmt::format("{} and {}: {} and {} poses without stamps (KITTI) cannot be matched by number; write "
                  "both as TUM: stamp_s tx ty tz qx qy qz qw",
                  request.result, request.truth, result.file->path.size(), truth.file->path.size())};
}

bool is_planar(const std::optional<TrajectoryFile>& file) {
  return !file || eval::is_planar(eval::out_of_plane(file->path));
}

Trajectory in_plane(const SpacePath& path, WantedPlane plane) {
  return eval::on_plane(path, eval::onto_plane(plane.value_or(eval::Plane::kXy), path));
}

/// Headings count where both paths have them.
eval::TruthTrack without_headings(const eval::TruthTrack& track) {
  auto samples = track.samples();
  for (eval::TruthSample& sample : samples) sample.truth.theta_rad.reset();
  return eval::TruthTrack(std::move(samples));
}

/// One line for each trajectory that turns with one orientation in all rows.
std::vector<std::string> paths_without_orientation(const EvalResult& result, const EvalTruth& truth) {
  std::vector<std::string> lines;
  for (const auto& [file, name] : {std::pair(&result.file, "the result"), {&truth.file, "the ground truth"}})
    if (*file && !eval::has_orientation((*file)->path))
      lines.push_back(fmt::format(
          "all rows of {} have the same orientation, which is taken as not measured: headings are not used",
          name));
  return lines;
}

eval::Evaluation evaluate_in_plane(const EvalResult& result, const EvalTruth& truth, WantedPlane plane) {
  const Trajectory path = result.file ? in_plane(result.file->path, plane) : result.trajectory;
  auto track =
      truth.file ? eval::TruthTrack::from_trajectory(in_plane(truth.file->path, plane)) : truth.track;
  const std::vector<std::string> without = paths_without_orientation(result, truth);
  if (!without.empty()) track = without_headings(track);
  auto evaluation = eval::evaluate(path, result.map, track, truth.landmarks, {}, truth.options);
  evaluation.notes.insert(evaluation.notes.begin(), without.begin(), without.end());
  return evaluation;
}

std::string span_of(const SpacePath& path) {
  if (path.empty()) return "nothing";
  return fmt::format("{} to {} s", to_string(path.front().stamp), to_string(path.back().stamp));
}

Result<eval::Evaluation> score(const EvalRequest& request, const EvalResult& result, const EvalTruth& truth) {
  WantedPlane plane;
  if (!request.plane.empty()) plane = eval::plane_named(request.plane);
  if (auto done = check_stamps(request, result, truth); !done) return done.error();
  const SpacePaths paths = paths_of(result, truth);
  auto evaluation = plane || (is_planar(result.file) && is_planar(truth.file))
                        ? evaluate_in_plane(result, truth, plane)
                        : eval::evaluate_in_space(paths.result, paths.truth, truth.options.associate);
  if (evaluation.pairs == 0 && !paths.truth.empty())
    return Error{
        fmt::format("{}: does not overlap in time with {}: the estimate covers {}, the ground truth {}",
                    request.result, request.truth, span_of(paths.result), span_of(paths.truth))};
  return evaluation;
}

Result<void> evaluate(const EvalRequest& request) {
  const auto result = read_eval_result(request.result, request.flags.settings());
  if (!result) return result.error();
  const auto truth = read_eval_truth(request.truth, request.flags.settings());
  if (!truth) return truth.error();
  auto evaluation = score(request, *result, *truth);
  if (!evaluation) return evaluation.error();
  auto& notes = evaluation->notes;
  notes.insert(notes.begin(), truth->notes.begin(), truth->notes.end());
  notes.insert(notes.begin(), result->notes.begin(), result->notes.end());
  fmt::print("{}", request.verbosity.json ? truth_json_text(*evaluation) : to_text(*evaluation));
  return {};
}

}  // namespace

void add_eval(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand(
      "eval", "Compute the errors of a result against ground truth, with and without alignment");
  auto request = std::make_shared<EvalRequest>();
  command
      ->add_option(
          "result", request->result,
          "folder that `waymark run` wrote, a trajectory (TUM, EuRoC, KITTI), or a log, whose odometry "
          "is scored")
      ->required()
      ->type_name("RESULT");
  command
      ->add_option(
          "--truth", request->truth,
          "log of any kind with ground truth, a trajectory (TUM, EuRoC, KITTI), or a folder of another "
          "run")
      ->required()
      ->type_name("LOG_OR_FILE");
  command
      ->add_option(
          "--plane", request->plane,
          "plane in which trajectories are scored: xy, xz, yz, or fit, of each path by itself; without "
          "it, x-y or in space where they leave that")
      ->check(CLI::IsMember({"xy", "xz", "yz", "fit"}))
      ->type_name("PLANE");
  request->flags.add_to(*command);
  command->add_flag("--json", request->verbosity.json,
                    "print the errors as JSON on standard output and nothing else there");
  command->footer(
      "Examples:\n  waymark eval out --truth LOG\n  waymark eval mine.tum --truth reference.tum --json");
  command->callback([&work, request] { work = [request] { return evaluate(*request); }; });
}

}  // namespace waymark::app
