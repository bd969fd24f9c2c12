#include "workbench/report/results.hpp"

#include "workbench/logs/files.hpp"
#include "workbench/logs/map_files.hpp"
#include "workbench/logs/pose_covariances.hpp"
#include "workbench/logs/tum.hpp"
#include "workbench/report/report.hpp"
#include "workbench/report/run_report.hpp"
#include "workbench/run/acting_keys.hpp"

namespace waymark {
namespace {

Result<void> write_trajectory(const std::filesystem::path& path, const Trajectory& trajectory) {
  auto writer = TumWriter::open(path);
  if (!writer) return writer.error();
  for (const auto& point : trajectory) writer->write(point.stamp, point.pose);
  return writer->close();
}

Result<void> write_path(const RunResult& result, const std::filesystem::path& folder) {
  const Trajectory& trajectory = result.recording.trajectory;
  if (auto written = write_trajectory(folder / "trajectory.tum", trajectory); !written) return written;
  return write_pose_covariances(folder / "trajectory_covariance.csv", trajectory);
}

Result<void> write_maps(const RunResult& result, const std::filesystem::path& folder) {
  const Snapshot snapshot = result.recording.filter->snapshot();
  if (auto written = write_map_csv(folder / "map.csv", snapshot); !written) return written;
  MapState map = save_map(result.recording);
  map.made_by = result.metrics.filter + " on " + result.input;
  return write_map(folder / "map.waymark", map);
}

Result<void> write_smoothed(const RunResult& result, const std::filesystem::path& folder) {
  if (!result.smoothed) return {};
  const smooth::Smoothed& smoothed = *result.smoothed;
  if (auto written = write_trajectory(folder / "trajectory_smoothed.tum", smoothed.trajectory); !written)
    return written;
  const Snapshot snapshot{smoothed.trajectory.back().stamp, {}, smoothed.landmarks};
  return write_map_csv(folder / "map_smoothed.csv", snapshot);
}

/// What the whole log says, or else the filter.
Result<void> write_calibration(const RunResult& result, const std::filesystem::path& folder) {
  const auto live = result.recording.filter->calibration();
  if (!result.smoothed && !live) return {};
  const CalibrationEstimate& estimate = result.smoothed ? result.smoothed->calibration : *live;
  return write_file(folder / "calibration.yaml", smooth::calibration_yaml(estimate, result.config));
}

}  // namespace

Result<RunResult> run_log(const std::string& input, const UserSettings& user, const TimeSpan& span,
                          const std::function<bool(double)>& keep_going) {
  auto run = study::run_and_score(input, user, span, keep_going);
  if (!run) return run.error();
  RunResult result{*std::move(run), {}};
  result.metrics = make_metrics(input, result.config, result.recording, result.evaluation);
  if (result.smoothed)
    result.metrics.smoothed =
        smoothed_figures(*result.smoothed, result.config, result.recording, result.smoothed_evaluation);
  return result;
}

Result<void> write_results(const RunResult& result, const std::filesystem::path& folder,
                           const std::string& command, bool with_trajectory) {
  if (auto made = ensure_output_folder(folder); !made) return made;
  if (with_trajectory)
    if (auto written = write_path(result, folder); !written) return written;
  if (auto written = write_maps(result, folder); !written) return written;
  if (auto written = write_smoothed(result, folder); !written) return written;
  if (auto written = write_calibration(result, folder); !written) return written;
  const std::string config = acting_yaml(result.config, result.log, result.recording.odometry);
  if (auto written = write_file(folder / "config.yaml", config); !written) return written;
  if (auto written = write_file(folder / "metrics.json", to_json(result.metrics)); !written) return written;
  return write_report(make_report(result, command), folder / "report.html");
}

}  // namespace waymark
