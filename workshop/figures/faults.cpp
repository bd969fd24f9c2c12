#include "workshop/figures/faults.hpp"

#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "workbench/report/results.hpp"
#include "workshop/figures/over_runs.hpp"

namespace waymark {
namespace {

struct FaultsRequest {
  std::string world = "sim:study";
  std::string filter = "ekf";
  int seeds = 30;
  int first_seed = 1;
  std::vector<std::string> settings;
};

using Settings = std::vector<std::string>;

std::optional<RunResult> run(const FaultsRequest& request, int seed, const Settings& faults) {
  Settings settings{"filter=" + request.filter, fmt::format("seed={}", seed), "fastslam.particles=150"};
  settings.insert(settings.end(), faults.begin(), faults.end());
  settings.insert(settings.end(), request.settings.begin(), request.settings.end());
  auto result = run_log(request.world, {{}, settings});
  if (!result) fmt::print(stderr, "seed {}: {}\n", seed, result.error().message);
  return result && result->evaluation ? std::optional(std::move(*result)) : std::nullopt;
}

/// A run with faults and its twin without.
struct TwinRuns {
  double rmse_m = NAN;
  double twin_rmse_m = NAN;
  double nees = NAN;
  double twin_nees = NAN;
  int seed = 0;

  [[nodiscard]] double ratio() const { return rmse_m / twin_rmse_m; }
  /// Of the bound that no seed may pass.
  [[nodiscard]] bool is_bad() const { return !(rmse_m <= 1.5 * twin_rmse_m + 0.05); }
};

TwinRuns run_twins(const FaultsRequest& request, int seed, Settings faults) {
  const auto with = run(request, seed, faults);
  faults.emplace_back("sim.omit_false=true");
  const auto without = run(request, seed, faults);
  if (!with || !without) return {.seed = seed};
  return {with->evaluation->path.position_rmse_m.value_or(NAN),
          without->evaluation->path.position_rmse_m.value_or(NAN), with->evaluation->nees.mean.value_or(NAN),
          without->evaluation->nees.mean.value_or(NAN), seed};
}

void print_fault_row(const FaultsRequest& request, const std::string& name, const Settings& faults) {
  std::vector<TwinRuns> runs(static_cast<std::size_t>(request.seeds));
  for_all_runs(request.seeds, [&](int i) {
    runs[static_cast<std::size_t>(i)] = run_twins(request, request.first_seed + i, faults);
  });
  const TwinRuns& worst = *std::ranges::max_element(runs, {}, &TwinRuns::ratio);
  const double rmse_m = mean(runs, &TwinRuns::rmse_m);
  const double twin_m = mean(runs, &TwinRuns::twin_rmse_m);
  const double nees = mean(runs, &TwinRuns::nees);
  const double twin_nees = mean(runs, &TwinRuns::twin_nees);
  fmt::print("{:<34}{:>8.3f}{:>8.3f}{:>7.2f}{:>9.1f}{:>7.1f}{:>7.2f}{:>8.2f} (seed {}){:>6}\n", name, rmse_m,
             twin_m, rmse_m / twin_m, nees, twin_nees, nees / twin_nees, worst.ratio(), worst.seed,
             std::ranges::count_if(runs, &TwinRuns::is_bad));
}

void print_faults(const FaultsRequest& request) {
  fmt::print(
      "{}, {}, seeds {} to {}: position RMSE in m and NEES, means over the seeds, with the faults and "
      "without\n",
      request.world, request.filter, request.first_seed, request.first_seed + request.seeds - 1);
  fmt::print("{:<34}{:>8}{:>8}{:>7}{:>9}{:>7}{:>7}{:>8}{:>18}\n", "fault", "RMSE", "without", "ratio", "NEES",
             "without", "ratio", "worst", "above 1.5x+5cm");
  print_fault_row(request, "first observation of 1 landmark", {"sim.false_first_share=0.001"});
  print_fault_row(request, "of 2 landmarks", {"sim.false_first_share=0.084"});
  print_fault_row(request, "of 5 % of the landmarks", {"sim.false_first_share=0.05"});
  print_fault_row(request, "of every landmark", {"sim.false_first_share=1"});
  print_fault_row(request, "10 % of all observations", {"sim.outlier_share=0.1"});
  print_fault_row(request, "one landmark carried 2 m half way", {"sim.landmark_carried_at_s=88"});
}

struct Errors {
  double position_m;
  double heading_rad;
};

std::map<Stamp, Errors> errors_over_time(const RunResult& result) {
  std::map<Stamp, Errors> errors;
  for (const auto& sample : result.evaluation->series)
    if (sample.heading_rad) errors[sample.stamp] = {sample.position_m.norm(), std::abs(*sample.heading_rad)};
  return errors;
}

/// When the third of the landmarks that were seen before was seen five times after.
std::optional<Stamp> third_landmark(const RunResult& result, Stamp carried) {
  std::map<LandmarkId, int> before;
  std::map<LandmarkId, int> after;
  int enough = 0;
  for (const auto& [stamp, innovation] : result.recording.innovations) {
    if (stamp < carried)
      ++before[innovation.landmark];
    else if (before.contains(innovation.landmark) && ++after[innovation.landmark] == 5 && ++enough == 3)
      return stamp;
  }
  return std::nullopt;
}

/// What became of a robot that was carried.
struct CarriedRun {
  bool counts = false;      ///< three known landmarks were seen with 10 s left
  bool found = false;       ///< within 10 s it was where the twin's errors have it, and stayed
  bool found_late = false;  ///< at the end
  bool said = false;        ///< it knew that it was lost
  int seed = 0;
};

bool is_close(const std::map<Stamp, Errors>& errors, const std::map<Stamp, Errors>& twin, Stamp from) {
  constexpr double kNear_m = 0.3;
  const double near_rad = to_radians(5.0);
  for (auto at = errors.lower_bound(from); at != errors.end(); ++at) {
    const auto other = twin.find(at->first);
    if (other == twin.end()) continue;
    return at->second.position_m <= other->second.position_m + kNear_m &&
           at->second.heading_rad <= other->second.heading_rad + near_rad;
  }
  return false;
}

CarriedRun run_carried(const FaultsRequest& request, int seed) {
  // Laps of the study take 88 s; the second and third of four.
  const double at_s = 90.0 + 170.0 * std::fmod(0.618 * seed, 1.0);
  const auto twin = run(request, seed, {"sim.laps=4"});
  const auto carried = run(request, seed, {"sim.laps=4", fmt::format("sim.robot_carried_at_s={}", at_s)});
  if (!twin || !carried) return {.seed = seed};
  CarriedRun kept{.seed = seed};
  const auto third = third_landmark(*carried, stamp_from_seconds(at_s));
  const auto errors = errors_over_time(*carried);
  const auto twin_errors = errors_over_time(*twin);
  const Stamp in_time = third.value_or(Stamp{}) + std::chrono::seconds(10);
  kept.counts = third && in_time <= errors.rbegin()->first;
  kept.found = kept.counts && is_close(errors, twin_errors, in_time);
  const Stamp end = std::prev(errors.end(), 2)->first;
  kept.found_late = is_close(errors, twin_errors, end);
  return kept;
}

void print_carried(const FaultsRequest& request) {
  std::vector<CarriedRun> runs(static_cast<std::size_t>(request.seeds));
  for_all_runs(request.seeds, [&](int i) {
    runs[static_cast<std::size_t>(i)] = run_carried(request, request.first_seed + i);
  });
  const auto count = [&](auto member) { return std::ranges::count_if(runs, member); };
  const auto counted = count(&CarriedRun::counts);
  fmt::print("{}, {}, seeds {} to {}: the robot is carried 2 m and 90 degrees in lap 2 or 3 of 4\n",
             request.world, request.filter, request.first_seed, request.first_seed + request.seeds - 1);
  fmt::print("three known landmarks seen five times each with 10 s left: {} runs\n", counted);
  fmt::print("  found back within 10 s: {} ({:.0f} %)\n", count(&CarriedRun::found),
             100.0 * static_cast<double>(count(&CarriedRun::found)) /
                 static_cast<double>(std::max<long>(1, counted)));
  fmt::print("  not, nor by the end: {}\n",
             count([](const CarriedRun& r) { return r.counts && !r.found && !r.found_late; }));
  fmt::print("seeds not in time:");
  for (const CarriedRun& each : runs)
    if (each.counts && !each.found) fmt::print(" {}{}", each.seed, each.found_late ? "" : "!");
  fmt::print("\nother runs not found by the end: {}\n",
             count([](const CarriedRun& r) { return !r.counts && !r.found_late; }));
}

}  // namespace

void add_faults(CLI::App& app) {
  auto request = std::make_shared<FaultsRequest>();
  const auto add = [&](const char* name, const char* what, void (*print)(const FaultsRequest&)) {
    auto* command = app.add_subcommand(name, what);
    command->add_option("--world", request->world);
    command->add_option("--filter", request->filter)->check(CLI::IsMember({"ekf", "fastslam"}));
    command->add_option("--seeds", request->seeds)->check(CLI::PositiveNumber);
    command->add_option("--first", request->first_seed, "the first of the seeds")->check(CLI::PositiveNumber);
    command->add_option("--set", request->settings, "config key=value")->allow_extra_args(false);
    command->callback([request, print] { print(*request); });
  };
  add("faults", "false observations and carried landmarks, against the same runs without", print_faults);
  add("carried", "a robot that is carried, against itself left alone", print_carried);
}

}  // namespace waymark
