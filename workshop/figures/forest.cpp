#include "workshop/figures/forest.hpp"

#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "workbench/eval/map_error.hpp"
#include "workbench/report/results.hpp"
#include "workbench/run/recording_figures.hpp"
#include "workshop/figures/over_runs.hpp"

namespace waymark {
namespace {

struct ForestRequest {
  std::string filter = "fastslam";
  std::string associate;
  int seeds = 50;
  int particles = 150;
  int observations = 10;
  std::optional<int> trunks;
  std::optional<double> field_m;
  std::optional<double> clutter;
  std::vector<std::string> settings;
};

/// What is kept of one run. Landmarks are matched with the nearest, whether they have names or not.
struct ForestRun {
  double rmse_m = NAN;
  double aligned_rmse_m = NAN;
  double dead_reckoning_rmse_m = NAN;
  double landmark_rmse_m = NAN;
  double nees_median = NAN;
  double step_us = NAN;
  double map = 0.0;
  double spurious = 0.0;
  double seen = 0.0;  ///< trunks that were sighted often enough
  double missed = 0.0;
};

struct Pair {
  ForestRun known;
  ForestRun unknown;
};

using ObservationCounts = std::map<LandmarkId, int>;

/// Trunks as far apart, and a path as far from the edge, as in the field of 30 m.
constexpr double kPathInside_m = 6.0;

std::vector<std::string> settings_for(const ForestRequest& request, int seed, bool identities) {
  std::vector<std::string> settings{"filter=" + request.filter, fmt::format("seed={}", seed),
                                    fmt::format("fastslam.particles={}", request.particles),
                                    fmt::format("sim.identities={}", identities)};
  if (request.trunks) settings.push_back(fmt::format("sim.landmarks={}", *request.trunks));
  if (request.field_m) {
    settings.push_back(fmt::format("sim.landmark_area_m={}", *request.field_m));
    settings.push_back(fmt::format("sim.side_m={}", *request.field_m - kPathInside_m));
  }
  if (request.clutter) settings.push_back(fmt::format("sim.clutter_probability={}", *request.clutter));
  if (!identities && !request.associate.empty()) settings.push_back("associate=" + request.associate);
  settings.insert(settings.end(), request.settings.begin(), request.settings.end());
  return settings;
}

std::optional<RunResult> run(const ForestRequest& request, int seed, bool identities) {
  auto result = run_log("sim:forest", {{}, settings_for(request, seed, identities)});
  if (!result) fmt::print(stderr, "seed {}: {}\n", seed, result.error().message);
  return result && result->evaluation ? std::optional(std::move(*result)) : std::nullopt;
}

/// How often each trunk was sighted: the run with identities says so.
ObservationCounts count_observations(const RunResult& known) {
  ObservationCounts observations;
  for (const auto& [stamp, innovation] : known.recording.innovations) ++observations[innovation.landmark];
  return observations;
}

void count_landmarks(ForestRun& kept, const RunResult& result, const ObservationCounts& observations,
                     int least) {
  const eval::Evaluation& e = *result.evaluation;
  if (!e.fit) return;
  const auto map = result.recording.filter->snapshot().landmarks;
  const auto& survey = result.log.landmarks;
  const auto matches = eval::match_nearest(map, survey, e.fit->T_truth_estimate);
  std::vector<bool> found(survey.size());
  for (const eval::LandmarkMatch& match : matches) found[match.surveyed] = true;
  kept.map = static_cast<double>(map.size());
  kept.spurious = static_cast<double>(map.size() - matches.size());
  for (std::size_t j = 0; j < survey.size(); ++j) {
    const auto count = observations.find(survey[j].id);
    if (count == observations.end() || count->second < least) continue;
    kept.seen += 1.0;
    kept.missed += found[j] ? 0.0 : 1.0;
  }
  const auto error =
      eval::map_error(map, survey, {std::nullopt, e.fit->T_truth_estimate}, eval::LandmarkNames::kUnknown);
  if (error) kept.landmark_rmse_m = error->rmse_m.value_or(NAN);
}

ForestRun keep(const RunResult& result, const ObservationCounts& observations, int least) {
  const eval::Evaluation& e = *result.evaluation;
  ForestRun kept;
  kept.rmse_m = e.path.position_rmse_m.value_or(NAN);
  kept.aligned_rmse_m = e.path.position_rmse_aligned_m.value_or(NAN);
  kept.dead_reckoning_rmse_m = e.odometry.position_rmse_m.value_or(NAN);
  kept.nees_median = e.nees.median.value_or(NAN);
  kept.step_us = step_times(result.recording.steps).mean_us;
  count_landmarks(kept, result, observations, least);
  return kept;
}

Pair run_both(const ForestRequest& request, int seed) {
  const auto known = run(request, seed, true);
  const auto unknown = run(request, seed, false);
  if (!known || !unknown) return {};
  const ObservationCounts observations = count_observations(*known);
  return {keep(*known, observations, request.observations),
          keep(*unknown, observations, request.observations)};
}

void print_row(const char* name, const std::vector<ForestRun>& runs) {
  fmt::print("{:<9}{:>8.3f}{:>8.3f}{:>9.3f}{:>8.3f}{:>9.3f}{:>8.3f}{:>8.1f}{:>11.2f}{:>9.2f}{:>9.0f}{:>10}\n",
             name, mean(runs, &ForestRun::rmse_m), median(runs, &ForestRun::rmse_m),
             mean(runs, &ForestRun::aligned_rmse_m), median(runs, &ForestRun::aligned_rmse_m),
             mean(runs, &ForestRun::landmark_rmse_m), median(runs, &ForestRun::landmark_rmse_m),
             median(runs, &ForestRun::nees_median),
             100.0 * sum(runs, &ForestRun::spurious) / sum(runs, &ForestRun::map),
             100.0 * sum(runs, &ForestRun::missed) / sum(runs, &ForestRun::seen),
             mean(runs, &ForestRun::step_us), count_diverged(runs));
}

void print_table(const ForestRequest& request) {
  std::vector<ForestRun> known(static_cast<std::size_t>(request.seeds));
  std::vector<ForestRun> unknown(known.size());
  for_all_runs(request.seeds, [&](int i) {
    const Pair pair = run_both(request, i + 1);
    known[static_cast<std::size_t>(i)] = pair.known;
    unknown[static_cast<std::size_t>(i)] = pair.unknown;
  });
  const auto filter =
      request.filter == "ekf" ? "EKF" : fmt::format("FastSLAM, {} particles", request.particles);
  fmt::print("world forest, {}, {} seeds; RMSE in m as mean and median\n", filter, request.seeds);
  fmt::print("{:<9}{:>16}{:>17}{:>17}{:>8}{:>11}{:>9}{:>9}{:>10}\n", "identity", "position", "aligned",
             "landmarks", "NEES", "spurious %", "missed %", "us/step", "diverged");
  print_row("known", known);
  print_row("unknown", unknown);
  fmt::print("unknown against known, position: mean {:.2f}, median {:.2f}\n",
             mean(unknown, &ForestRun::rmse_m) / mean(known, &ForestRun::rmse_m),
             median(unknown, &ForestRun::rmse_m) / median(known, &ForestRun::rmse_m));
  fmt::print("missed counts trunks with {} observations or more: {:.1f} of a run's\n", request.observations,
             mean(known, &ForestRun::seen));
}

}  // namespace

void add_forest(CLI::App& app) {
  auto* command = app.add_subcommand("forest", "a filter with unknown and with known identities");
  auto request = std::make_shared<ForestRequest>();
  command->add_option("--filter", request->filter)->check(CLI::IsMember({"ekf", "fastslam"}));
  command->add_option("--associate", request->associate, "how it does without identities");
  command->add_option("--trunks", request->trunks)->check(CLI::PositiveNumber);
  command->add_option("--field", request->field_m, "side of the square that they stand on, m")
      ->check(CLI::Range(10.0, 1000.0));
  command->add_option("--clutter", request->clutter, "chance that an observation comes with a false one");
  command->add_option("--seeds", request->seeds)->check(CLI::PositiveNumber);
  command->add_option("--particles", request->particles)->check(CLI::PositiveNumber);
  command->add_option("--observations", request->observations,
                      "least observations of a trunk that may be missed");
  command->add_option("--set", request->settings, "config key=value")->allow_extra_args(false);
  command->callback([request] { print_table(*request); });
}

}  // namespace waymark
