#include "workshop/figures/room.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "workbench/report/results.hpp"
#include "workshop/figures/over_runs.hpp"

namespace waymark {
namespace {

struct RoomRequest {
  std::string scenario = "room";
  int seeds = 24;
  std::vector<std::string> settings;
};

struct RoomRun {
  double final_m = NAN;
  double odometry_final_m = NAN;
  double rmse_m = NAN;
  double dead_reckoning_rmse_m = NAN;
  double nees_mean = NAN;
  NeesOverTime nees;
};

RoomRun drive(const RoomRequest& request, int seed) {
  std::vector<std::string> settings = request.settings;
  settings.emplace_back("observe=pixel");
  settings.push_back(fmt::format("seed={}", seed));
  const auto result = run_log("sim:" + request.scenario, {{}, std::move(settings)});
  if (!result || !result->evaluation) return {};
  const eval::Evaluation& e = *result->evaluation;
  RoomRun run{e.path.final_error_m.value_or(NAN),
              e.odometry.final_error_m.value_or(NAN),
              e.path.position_rmse_m.value_or(NAN),
              e.odometry.position_rmse_m.value_or(NAN),
              e.nees.mean.value_or(NAN),
              {}};
  for (const auto& sample : e.series)
    if (sample.nees) run.nees[sample.stamp] = *sample.nees;
  return run;
}

double quantile(const std::vector<RoomRun>& runs, double RoomRun::*member, double part) {
  std::vector<double> values;
  for (const RoomRun& run : runs) values.push_back(run.*member);
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(std::ceil(part * static_cast<double>(values.size()))) - 1];
}

int room(const RoomRequest& request) {
  std::vector<RoomRun> runs(static_cast<std::size_t>(request.seeds));
  for_all_runs(request.seeds, [&](int i) { runs[static_cast<std::size_t>(i)] = drive(request, i + 1); });
  if (std::ranges::any_of(runs, [](const RoomRun& run) { return std::isnan(run.rmse_m); })) {
    fmt::print(stderr, "sim:{}: a run has no result; `waymark run` says why\n", request.scenario);
    return 1;
  }
  std::vector<NeesOverTime> nees;
  for (const RoomRun& run : runs) nees.push_back(run.nees);
  fmt::print("sim:{}, {} seeds, natural corners in rendered images\n", request.scenario, request.seeds);
  fmt::print("final error, m: median {:.3f}, 95 % below {:.3f}, largest {:.3f}; odometry alone {:.2f}\n",
             median(runs, &RoomRun::final_m), quantile(runs, &RoomRun::final_m, 0.95),
             quantile(runs, &RoomRun::final_m, 1.0), median(runs, &RoomRun::odometry_final_m));
  fmt::print("position RMSE, m: median {:.3f}, largest {:.3f}; diverged {}\n", median(runs, &RoomRun::rmse_m),
             quantile(runs, &RoomRun::rmse_m, 1.0), count_diverged(runs));
  fmt::print(
      "pose NEES over a run: median {:.1f}, mean {:.1f}; mean of the runs inside its 99 % band in "
      "{:.1f} % of the images\n",
      median(runs, &RoomRun::nees_mean), mean(runs, &RoomRun::nees_mean),
      100.0 * part_inside(nees, 0.0, HUGE_VAL));
  return 0;
}

}  // namespace

void add_room(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("room", "the camera system over many drives through a rendered room");
  auto request = std::make_shared<RoomRequest>();
  command->add_option("--scenario", request->scenario, "room or corridor");
  command->add_option("--seeds", request->seeds, "drives")->check(CLI::PositiveNumber);
  command->add_option("--set", request->settings, "config key=value")->allow_extra_args(false);
  command->callback([request, &status] { status = room(*request); });
}

}  // namespace waymark
