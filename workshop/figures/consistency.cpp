#include "workshop/figures/consistency.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "workshop/figures/consistency_report.hpp"

namespace waymark {
namespace {

void print(const study::ConsistencyComparison& comparison) {
  const auto& options = comparison.options;
  fmt::print("odometry {:.0f} cm and {:.0f} deg per step, {} runs of {} steps\n",
             100.0 * options.odometry_sigma_m, to_degrees(options.odometry_sigma_rad), options.runs,
             options.steps);
  fmt::print("{:<12}{:>12}{:>20}{:>20}{:>20}\n", "mode", "mean NEES", "99 % band", "steps inside, %",
             "position RMSE, m");
  for (const auto& [name, result] : comparison.modes)
    fmt::print("{:<12}{:>12.2f}{:>20}{:>20.1f}{:>20.4f}\n", name, result.nees_mean,
               fmt::format("{:.2f} to {:.2f}", result.low, result.high),
               std::round(1000.0 * result.part_inside) / 10.0, result.position_rmse_m);
}

int consistency(study::ConsistencyOptions options, const std::string& page) {
  const int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  ConsistencyReport report{
      fmt::format("waymark-figures consistency --runs {} --steps {} --landmarks {} --seed {}", options.runs,
                  options.steps, options.landmarks, options.seed),
      {}};
  for (const auto& [sigma_m, sigma_deg] : {std::pair{0.02, 1.0}, std::pair{0.04, 3.0}}) {
    options.odometry_sigma_m = sigma_m;
    options.odometry_sigma_rad = to_radians(sigma_deg);
    report.comparisons.push_back(study::compare_modes(options, threads));
    print(report.comparisons.back());
  }
  if (page.empty()) return 0;
  const auto written = write_consistency_report(report, page);
  if (!written) fmt::print(stderr, "{}\n", written.error().message);
  return written ? 0 : 1;
}

}  // namespace

void add_consistency(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("consistency", "pose NEES of the EKF's modes at mild and poor odometry");
  auto options = std::make_shared<study::ConsistencyOptions>();
  auto page = std::make_shared<std::string>();
  command->add_option("--runs", options->runs)->check(CLI::PositiveNumber);
  command->add_option("--steps", options->steps)->check(CLI::PositiveNumber);
  command->add_option("--landmarks", options->landmarks)->check(CLI::PositiveNumber);
  command->add_option("--seed", options->seed);
  command->add_option("-o,--output", *page, "write a page with charts as well")->type_name("FILE.html");
  command->callback([&status, options, page] { status = consistency(*options, *page); });
}

}  // namespace waymark
