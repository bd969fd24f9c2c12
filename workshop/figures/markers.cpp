#include "workshop/figures/markers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "workbench/report/results.hpp"
#include "workshop/figures/over_runs.hpp"

namespace waymark {
namespace {

struct MarkersRequest {
  int seeds = 20;
  std::string filter = "ekf";
  std::vector<std::string> settings;
};

struct MarkersRun {
  double rmse_m = NAN;
  double dead_reckoning_rmse_m = NAN;
  double landmark_rmse_m = NAN;
  double landmark_worst_m = NAN;
  double landmarks_missed = NAN;
  double landmarks_spurious = NAN;
  double nees_mean = NAN;
  double nis_per_dof = NAN;
  double image_ms = NAN;  ///< detection, measurement and filter
  NeesOverTime nees;
};

/// Of the landmarks in the map and in the survey, anchored.
double worst_landmark_m(const RunResult& result) {
  const auto map = result.recording.filter->snapshot().landmarks;
  const auto& survey = result.log.landmarks;
  double worst_m = 0.0;
  for (const auto& [estimated, surveyed] : eval::match_by_number(map, survey))
    worst_m = std::max(worst_m, eval::landmark_error_m(map[estimated], survey[surveyed],
                                                       result.evaluation->anchor->T_truth_estimate)
                                    .head<2>()
                                    .norm());
  return worst_m;
}

double image_ms(const Recording& recording) {
  double total_ms = 0.0;
  for (const FunctionBlocks::Row& row : recording.blocks) total_ms += 1e3 * to_seconds(row.total);
  return total_ms / static_cast<double>(std::max<std::int64_t>(1, recording.counts.images));
}

MarkersRun drive(const MarkersRequest& request, int seed) {
  std::vector<std::string> settings{"filter=" + request.filter, fmt::format("seed={}", seed)};
  settings.insert(settings.end(), request.settings.begin(), request.settings.end());
  const auto result = run_log("sim:marker-room", {{}, std::move(settings)});
  if (!result || !result->evaluation || !result->evaluation->map || !result->evaluation->anchor) return {};
  const eval::Evaluation& e = *result->evaluation;
  MarkersRun run{e.path.position_rmse_m.value_or(NAN),
                 e.odometry.position_rmse_m.value_or(NAN),
                 e.map->rmse_anchored_m.value_or(NAN),
                 worst_landmark_m(*result),
                 static_cast<double>(e.map->missed),
                 static_cast<double>(e.map->spurious),
                 e.nees.mean.value_or(NAN),
                 result->metrics.nis_per_dof.value_or(NAN),
                 image_ms(result->recording),
                 {}};
  for (const auto& sample : e.series)
    if (sample.nees) run.nees[sample.stamp] = *sample.nees;
  return run;
}

double largest(const std::vector<MarkersRun>& runs, double MarkersRun::*member) {
  return (*std::ranges::max_element(runs, {}, member)).*member;
}

int drive_all(const MarkersRequest& request) {
  std::vector<MarkersRun> runs(static_cast<std::size_t>(request.seeds));
  for_all_runs(request.seeds, [&](int i) { runs[static_cast<std::size_t>(i)] = drive(request, i + 1); });
  if (std::ranges::any_of(runs, [](const MarkersRun& run) { return std::isnan(run.rmse_m); })) {
    fmt::print(stderr, "sim:marker-room: a run has no result; `waymark run` says why\n");
    return 1;
  }
  std::vector<NeesOverTime> nees;
  for (const MarkersRun& run : runs) nees.push_back(run.nees);
  fmt::print("sim:marker-room, {}, {} seeds\n", request.filter, request.seeds);
  fmt::print("position RMSE, m: mean {:.4f}, largest {:.4f}; dead reckoning {:.2f}\n",
             mean(runs, &MarkersRun::rmse_m), largest(runs, &MarkersRun::rmse_m),
             mean(runs, &MarkersRun::dead_reckoning_rmse_m));
  fmt::print("markers, m: RMSE mean {:.4f}, farthest of all {:.4f}; missed {}, spurious {}\n",
             mean(runs, &MarkersRun::landmark_rmse_m), largest(runs, &MarkersRun::landmark_worst_m),
             sum(runs, &MarkersRun::landmarks_missed), sum(runs, &MarkersRun::landmarks_spurious));
  fmt::print(
      "pose NEES over a run: mean {:.2f}, median {:.2f}; mean of the runs inside its 99 % band in {:.1f} % "
      "of "
      "the images; NIS per dof {:.2f}\n",
      mean(runs, &MarkersRun::nees_mean), median(runs, &MarkersRun::nees_mean),
      100.0 * part_inside(nees, 0.0, HUGE_VAL), mean(runs, &MarkersRun::nis_per_dof));
  fmt::print("CPU per image of 640 x 480, detection to filter: {:.1f} ms\n",
             median(runs, &MarkersRun::image_ms));
  return 0;
}

}  // namespace

void add_markers(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("markers", "markers in rendered rooms, over many drives");
  auto request = std::make_shared<MarkersRequest>();
  command->add_option("--seeds", request->seeds, "drives")->check(CLI::PositiveNumber);
  command->add_option("--filter", request->filter, "ekf or fastslam");
  command->add_option("--set", request->settings, "config key=value")->allow_extra_args(false);
  command->callback([request, &status] { status = drive_all(*request); });
}

}  // namespace waymark
