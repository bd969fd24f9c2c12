#include "eval_inputs.hpp"

#include <filesystem>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "waymark/slam/odometer.hpp"

#include "workbench/eval/space_path.hpp"
#include "workbench/logs/map_files.hpp"
#include "workbench/logs/pose_covariances.hpp"
#include "workbench/run/dead_reckoning.hpp"
#include "workbench/run/open_source.hpp"

namespace waymark::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTrajectory = "trajectory.tum";

bool is_run_folder(const fs::path& path) { return fs::exists(path / kTrajectory); }

/// A file of which no reader of logs takes itself to be.
bool is_trajectory_file(const fs::path& path) { return fs::is_regular_file(path) && !is_log(path); }

/// The landmarks of map.csv under the full ids of map.waymark: of an id the table has the number only.
Result<std::vector<LandmarkEstimate>> read_landmarks(const fs::path& folder) {
  if (!fs::exists(folder / "map.csv")) return std::vector<LandmarkEstimate>{};
  auto landmarks = read_map_csv(folder / "map.csv");
  if (!landmarks || !fs::exists(folder / "map.waymark")) return landmarks;
  const auto map = read_map(folder / "map.waymark");
  if (!map) return map.error();
  if (map->ids.size() != landmarks->size()) return landmarks;
  for (std::size_t i = 0; i < landmarks->size(); ++i) (*landmarks)[i].id = map->ids[i];
  return landmarks;
}

Trajectory on_floor(const SpacePath& path) {
  return eval::on_plane(path, eval::onto_plane(eval::Plane::kXy, path));
}

Result<EvalResult> read_run_folder(const fs::path& folder) {
  auto file = read_trajectory(folder / kTrajectory);
  if (!file) return file.error();
  EvalResult result{.trajectory = on_floor(file->path)};
  if (const fs::path covariances = folder / "trajectory_covariance.csv"; fs::exists(covariances))
    if (auto done = read_pose_covariances(covariances, result.trajectory); !done) return done.error();
  auto map = read_landmarks(folder);
  if (!map) return map.error();
  result.map = *std::move(map);
  return result;
}

/// All events of a log, and what it says of itself.
struct ReadLog {
  LogInfo info;
  Config config;
  std::vector<Event> events;
};

Result<ReadLog> read_log(const std::string& input, const UserSettings& user) {
  auto opened = open_input(input, user);
  if (!opened) return opened.error();
  ReadLog log{{}, opened->config, {}};
  while (true) {
    auto event = opened->source->next();
    if (!event) return event.error();
    if (!*event) break;
    const bool is_scored =
        std::holds_alternative<Truth>((*event)->content) || measures_motion((*event)->content);
    if (is_scored) log.events.push_back(**std::move(event));
  }
  log.info = opened->source->info();
  return log;
}

Result<EvalResult> read_log_odometry(const std::string& input, const UserSettings& user) {
  const auto log = read_log(input, user);
  if (!log) return log.error();
  auto path = dead_reckoning(log->events, log->config);
  if (!path) return path.error();
  if (path->empty())
    return Error{input + ": has no odometry to score; give a folder that `waymark run` wrote"};
  return EvalResult{
      .trajectory = *std::move(path),
      .notes = {input + " is a log: its odometry alone is scored; `waymark run` estimates its path"}};
}

Result<EvalTruth> read_log_truth(const std::string& input, const UserSettings& user) {
  auto log = read_log(input, user);
  if (!log) return log.error();
  EvalTruth truth{.track = eval::TruthTrack::from_events(log->events), .landmarks = log->info.landmarks};
  if (log->info.truth_sensor_m) truth.options.associate.truth_sensor_m = *log->info.truth_sensor_m;
  if (truth.track.empty() && truth.landmarks.empty())
    return Error{input +
                 ": no ground truth found: expected truth.csv or landmarks.csv in a log folder, "
                 "input.truth_topic for a bag, or a trajectory (TUM, EuRoC, KITTI)"};
  return truth;
}

/// What another run found as the reference.
Result<EvalTruth> read_run_as_truth(const fs::path& folder) {
  auto run = read_run_folder(folder);
  if (!run) return run.error();
  EvalTruth truth{.track = eval::TruthTrack::from_trajectory(run->trajectory)};
  for (const LandmarkEstimate& landmark : run->map)
    truth.landmarks.push_back(
        {landmark.id, landmark.position_m.x(), landmark.position_m.y(), landmark.position_m.z()});
  truth.notes.push_back(folder.string() + " is the result of a run, taken as ground truth");
  return truth;
}

}  // namespace

Result<EvalResult> read_eval_result(const std::string& input, const UserSettings& user) {
  if (is_run_folder(input)) return read_run_folder(input);
  if (!is_trajectory_file(input)) return read_log_odometry(input, user);
  auto file = read_trajectory(input);
  if (!file) return file.error();
  return EvalResult{.file = *file, .notes = file->notes};
}

Result<EvalTruth> read_eval_truth(const std::string& input, const UserSettings& user) {
  if (is_run_folder(input)) return read_run_as_truth(input);
  if (!is_trajectory_file(input)) return read_log_truth(input, user);
  auto file = read_trajectory(input);
  if (!file) return file.error();
  return EvalTruth{.file = *file, .notes = file->notes};
}

}  // namespace waymark::app
