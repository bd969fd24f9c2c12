// Prints the figures of docs/results.md: each subcommand one table.

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "waymark/core/parallel.hpp"

#include "workbench/report/results.hpp"
#include "workshop/figures/budget.hpp"
#include "workshop/figures/cameras.hpp"
#include "workshop/figures/compressed.hpp"
#include "workshop/figures/consistency.hpp"
#include "workshop/figures/contact_sheet.hpp"
#include "workshop/figures/desk.hpp"
#include "workshop/figures/faults.hpp"
#include "workshop/figures/forest.hpp"
#include "workshop/figures/initialise.hpp"
#include "workshop/figures/markers.hpp"
#include "workshop/figures/observe.hpp"
#include "workshop/figures/over_runs.hpp"
#include "workshop/figures/room.hpp"
#include "workshop/figures/verdicts.hpp"

namespace waymark {
namespace {

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double median_of(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// Prints the reason where there is no result.
std::optional<RunResult> run(const std::string& input, std::vector<std::string> settings) {
  auto result = run_log(input, {{}, std::move(settings)});
  if (!result) fmt::print(stderr, "{}: {}\n", input, result.error().message);
  return result ? std::optional(std::move(*result)) : std::nullopt;
}

/// The columns of the MRCLAM table.
struct Score {
  double anchored_m = 0.0;
  double aligned_m = 0.0;
  double map_m = 0.0;
  double nees = 0.0;
  double nis_per_dof = 0.0;
};

Score score(const RunResult& result) {
  const eval::Evaluation& e = *result.evaluation;
  Score s{e.path.position_rmse_m.value_or(NAN), e.path.position_rmse_aligned_m.value_or(NAN), NAN,
          e.nees.median.value_or(NAN), result.metrics.nis_per_dof.value_or(NAN)};
  if (e.map) s.map_m = e.map->rmse_self_m.value_or(NAN);
  return s;
}

/// Member by member over the seeds.
template <class Reduce>
Score combine(const std::vector<Score>& scores, const Reduce& reduce) {
  const auto column = [&](double Score::*member) {
    std::vector<double> values;
    for (const auto& s : scores) values.push_back(s.*member);
    return reduce(values);
  };
  return {column(&Score::anchored_m), column(&Score::aligned_m), column(&Score::map_m), column(&Score::nees),
          column(&Score::nis_per_dof)};
}

void print(const std::string& name, const Score& s) {
  fmt::print("{:<10}{:>10.3f}{:>10.3f}{:>10.3f}{:>12.1f}{:>10.2f}\n", name, s.anchored_m, s.aligned_m,
             s.map_m, s.nees, s.nis_per_dof);
}

void print_head(const char* rows) {
  fmt::print("{:<10}{:>10}{:>10}{:>10}{:>12}{:>10}\n", rows, "anchored", "aligned", "map self", "NEES median",
             "NIS/dof");
}

/// One filter over one log; FastSLAM as the median over seeds. Nothing where a run has no result.
std::optional<Score> score_filter(const std::string& input, const std::string& filter, int seeds,
                                  const std::vector<std::string>& extra) {
  std::vector<Score> scores;
  for (int seed = 1; seed <= (filter == "ekf" ? 1 : seeds); ++seed) {
    std::vector<std::string> settings{"filter=" + filter, fmt::format("seed={}", seed),
                                      "fastslam.particles=100"};
    settings.insert(settings.end(), extra.begin(), extra.end());
    const auto result = run(input, std::move(settings));
    if (!result || !result->evaluation) return std::nullopt;
    scores.push_back(score(*result));
  }
  return combine(scores, median_of);
}

/// One filter on several robots of an MRCLAM directory.
int mrclam(const std::string& folder, int robots, const std::string& filter, int seeds,
           const std::vector<std::string>& extra) {
  fmt::print("{} on {}: RMSE in m\n", filter, folder);
  print_head("robot");
  std::vector<Score> robots_scores;
  for (int robot = 1; robot <= robots; ++robot) {
    std::vector<std::string> settings{fmt::format("input.robot={}", robot)};
    settings.insert(settings.end(), extra.begin(), extra.end());
    const auto scored = score_filter(folder, filter, seeds, settings);
    if (!scored) return 1;
    robots_scores.push_back(*scored);
    print(std::to_string(robot), *scored);
  }
  print("mean", combine(robots_scores, mean_of));
  return 0;
}

/// Both filters on lost-in-the-woods.
int woods(const std::string& log, int seeds, const std::vector<std::string>& extra) {
  fmt::print("{}: RMSE in m\n", log);
  print_head("filter");
  for (const std::string filter : {"ekf", "fastslam"}) {
    const auto scored = score_filter(log, filter, seeds, extra);
    if (!scored) return 1;
    print(filter, *scored);
  }
  return 0;
}

/// Where the run ends relative to where it began: for logs that return to their start.
int loop_closure(const std::string& folder, std::vector<std::string> settings) {
  const auto result = run(folder, std::move(settings));
  if (!result || result->recording.trajectory.empty()) return 1;
  const auto report = [](const char* name, const Pose2& end) {
    fmt::print("{:<20} ends {:.3f} m and {:.2f} deg from its start\n", name, end.position().norm(),
               to_degrees(end.theta_rad));
  };
  report("odometry alone", result->recording.dead_reckoning.back().pose);
  report(result->metrics.filter.c_str(), result->recording.trajectory.back().pose);
  if (result->evaluation && result->evaluation->map && result->evaluation->map->rmse_self_m)
    fmt::print("landmark RMSE, aligned on the landmarks: {:.3f} m\n", *result->evaluation->map->rmse_self_m);
  return 0;
}

/// What the study keeps of one run.
struct StudyRun {
  double ekf_rmse_m = 0.0;
  double fastslam_rmse_m = 0.0;
  NeesOverTime nees;  ///< of the EKF
  bool ok = false;
};

StudyRun study_run(int seed, const std::vector<std::string>& extra) {
  StudyRun study;
  for (const std::string filter : {"ekf", "fastslam"}) {
    std::vector<std::string> settings{"filter=" + filter, fmt::format("seed={}", seed),
                                      "fastslam.particles=150"};
    settings.insert(settings.end(), extra.begin(), extra.end());
    const auto result = run("sim:study", std::move(settings));
    if (!result || !result->evaluation || !result->evaluation->path.position_rmse_m) return study;
    (filter == "ekf" ? study.ekf_rmse_m : study.fastslam_rmse_m) = *result->evaluation->path.position_rmse_m;
    if (filter == "ekf")
      for (const auto& sample : result->evaluation->series)
        if (sample.nees) study.nees[sample.stamp] = *sample.nees;
  }
  study.ok = true;
  return study;
}

int study_world(int seeds, const std::vector<std::string>& extra) {
  std::vector<StudyRun> runs(static_cast<std::size_t>(seeds));
  ThreadPool thread_pool(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  thread_pool.run(seeds, [&](int i) { runs[static_cast<std::size_t>(i)] = study_run(i + 1, extra); });
  if (!std::ranges::all_of(runs, &StudyRun::ok)) return 1;
  std::vector<double> ekf;
  std::vector<double> fastslam;
  std::vector<NeesOverTime> nees;
  for (const auto& one : runs) {
    nees.push_back(one.nees);
    ekf.push_back(one.ekf_rmse_m);
    fastslam.push_back(one.fastslam_rmse_m);
  }
  const double end_s = to_seconds(runs.front().nees.rbegin()->first);
  fmt::print("world study, {} seeds\n", seeds);
  fmt::print("EKF mean pose NEES inside its 99 % band: {:.1f} % of the first lap, {:.1f} % of the second\n",
             100.0 * part_inside(nees, 0.0, 0.5 * end_s),
             100.0 * part_inside(nees, 0.5 * end_s, 2.0 * end_s));
  fmt::print(
      "position RMSE, mean and median over the seeds: EKF {:.3f} {:.3f} m, FastSLAM (150 particles) {:.3f} "
      "{:.3f} m, ratio {:.2f} {:.2f}\n",
      mean_of(ekf), median_of(ekf), mean_of(fastslam), median_of(fastslam), mean_of(fastslam) / mean_of(ekf),
      median_of(fastslam) / median_of(ekf));
  return 0;
}

}  // namespace
}  // namespace waymark

int main(int argc, char** argv) {
  CLI::App app{"Prints the figures of docs/results.md", "waymark-figures"};
  app.require_subcommand(1);
  std::string folder;
  std::string filter = "ekf";
  int robots = 4;
  int seeds = 3;
  int study_seeds = 50;
  std::vector<std::string> settings;
  int status = 0;
  auto* mrclam = app.add_subcommand("mrclam", "errors on the robots of an MRCLAM directory");
  mrclam->add_option("directory", folder)->required();
  mrclam->add_option("--robots", robots);
  mrclam->add_option("--filter", filter);
  mrclam->add_option("--seeds", seeds, "FastSLAM: median over this many");
  mrclam->callback([&] { status = waymark::mrclam(folder, robots, filter, seeds, settings); });
  auto* woods = app.add_subcommand("woods", "errors of both filters on lost-in-the-woods");
  woods->add_option("log", folder)->required();
  woods->add_option("--seeds", seeds, "FastSLAM: median over this many");
  woods->callback([&] { status = waymark::woods(folder, seeds, settings); });
  auto* loop = app.add_subcommand("loop", "how far a log that returns to its start ends from it");
  loop->add_option("log", folder)->required();
  loop->callback([&] { status = waymark::loop_closure(folder, settings); });
  auto* study = app.add_subcommand("study", "the simulated world that serves every comparison");
  study->add_option("--seeds", study_seeds);
  study->callback([&] { status = waymark::study_world(study_seeds, settings); });
  int landmarks = 3000;
  int frames = 5000;
  int threads = 1;
  auto* compressed =
      app.add_subcommand("compressed", "what a step costs in a large map, and how exact it is");
  compressed->add_option("--landmarks", landmarks, "of the largest map")->check(CLI::Range(300, 100000));
  compressed->add_option("--frames", frames);
  compressed->add_option("--threads", threads);
  compressed->callback([&] { status = waymark::compressed(landmarks, frames, threads); });
  for (auto* command : {mrclam, woods, loop, study})
    command->add_option("--set", settings, "config key=value")->allow_extra_args(false);
  waymark::add_budget(app, status);
  waymark::add_cameras(app);
  waymark::add_consistency(app, status);
  waymark::add_contact_sheet(app, status);
  waymark::add_desk(app, status);
  waymark::add_initialise(app, status);
  waymark::add_faults(app);
  waymark::add_forest(app);
  waymark::add_markers(app, status);
  waymark::add_observe(app);
  waymark::add_room(app, status);
  waymark::add_verdicts(app);
  CLI11_PARSE(app, argc, argv);
  return status;
}
