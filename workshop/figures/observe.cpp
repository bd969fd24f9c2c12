#include "workshop/figures/observe.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "workbench/report/results.hpp"
#include "workshop/figures/over_runs.hpp"

namespace waymark {
namespace {

constexpr std::array kModes{"range-bearing", "range", "bearing"};

struct ObserveRequest {
  int seeds = 200;
  std::vector<std::string> settings;
};

/// What is kept of one run.
struct ObserveRun {
  double rmse_m = NAN;
  double dead_reckoning_rmse_m = NAN;
  double landmark_rmse_m = NAN;
  double nees_median = NAN;
};

ObserveRun run(const char* mode, int seed, const std::vector<std::string>& settings) {
  std::vector<std::string> all{"filter=fastslam", fmt::format("observe={}", mode),
                               fmt::format("seed={}", seed), "fastslam.particles=150"};
  all.insert(all.end(), settings.begin(), settings.end());
  const auto result = run_log("sim:study", {{}, std::move(all)});
  if (!result || !result->evaluation) return {};
  const eval::Evaluation& e = *result->evaluation;
  ObserveRun kept{e.path.position_rmse_m.value_or(NAN), e.odometry.position_rmse_m.value_or(NAN), NAN,
                  e.nees.median.value_or(NAN)};
  if (e.map) kept.landmark_rmse_m = e.map->rmse_m.value_or(NAN);
  return kept;
}

void print_table(const ObserveRequest& request) {
  const auto seeds = static_cast<std::size_t>(request.seeds);
  std::array<std::vector<ObserveRun>, kModes.size()> runs;
  runs.fill(std::vector<ObserveRun>(seeds));
  for_all_runs(request.seeds * static_cast<int>(kModes.size()), [&](int job) {
    const auto mode = static_cast<std::size_t>(job) % kModes.size();
    const int seed = job / static_cast<int>(kModes.size());
    runs[mode][static_cast<std::size_t>(seed)] = run(kModes[mode], seed + 1, request.settings);
  });
  fmt::print("world study, FastSLAM, {} seeds; RMSE in m as mean and median\n", request.seeds);
  fmt::print("{:<15}{:>18}{:>18}{:>18}{:>14}{:>10}\n", "observed", "position", "against both", "landmarks",
             "NEES median", "diverged");
  for (std::size_t mode = 0; mode < kModes.size(); ++mode)
    fmt::print("{:<15}{:>10.3f}{:>8.3f}{:>10.2f}{:>8.2f}{:>10.3f}{:>8.3f}{:>14.1f}{:>10}\n", kModes[mode],
               mean(runs[mode], &ObserveRun::rmse_m), median(runs[mode], &ObserveRun::rmse_m),
               mean(runs[mode], &ObserveRun::rmse_m) / mean(runs[0], &ObserveRun::rmse_m),
               median(runs[mode], &ObserveRun::rmse_m) / median(runs[0], &ObserveRun::rmse_m),
               mean(runs[mode], &ObserveRun::landmark_rmse_m),
               median(runs[mode], &ObserveRun::landmark_rmse_m), median(runs[mode], &ObserveRun::nees_median),
               count_diverged(runs[mode]));
}

}  // namespace

void add_observe(CLI::App& app) {
  auto* command = app.add_subcommand("observe", "FastSLAM by range and bearing, by either alone");
  auto request = std::make_shared<ObserveRequest>();
  command->add_option("--seeds", request->seeds)->check(CLI::PositiveNumber);
  command->add_option("--set", request->settings, "config key=value")->allow_extra_args(false);
  command->callback([request] { print_table(*request); });
}

}  // namespace waymark
