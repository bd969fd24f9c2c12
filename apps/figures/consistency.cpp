#include "figures/consistency.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "waymark/study/consistency.hpp"

namespace waymark {
namespace {

void print_modes(const study::ConsistencyOptions& options) {
  const int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  fmt::print("odometry {:.0f} cm and {:.0f} deg per step, {} runs of {} steps\n",
             100.0 * options.odometry_sigma_m, options.odometry_sigma_rad * 180.0 / kPi, options.runs,
             options.steps);
  fmt::print("{:<12}{:>12}{:>20}{:>20}{:>20}\n", "mode", "mean NEES", "99 % band", "steps inside, %",
             "position RMSE, m");
  for (const auto& [name, mode] :
       {std::pair{"invariant", ekf::Consistency::kInvariant}, std::pair{"fej", ekf::Consistency::kFej},
        std::pair{"standard", ekf::Consistency::kStandard}}) {
    const auto result = study_consistency(mode, options, threads);
    fmt::print("{:<12}{:>12.2f}{:>20}{:>20.1f}{:>20.4f}\n", name, result.nees_mean,
               fmt::format("{:.2f} to {:.2f}", result.low, result.high), 100.0 * result.part_inside,
               result.position_rmse_m);
  }
}

}  // namespace

void add_consistency(CLI::App& app) {
  auto* command = app.add_subcommand("consistency", "pose NEES of the EKF's modes at mild and poor odometry");
  auto options = std::make_shared<study::ConsistencyOptions>();
  command->add_option("--runs", options->runs)->check(CLI::PositiveNumber);
  command->add_option("--steps", options->steps)->check(CLI::PositiveNumber);
  command->add_option("--landmarks", options->landmarks)->check(CLI::PositiveNumber);
  command->add_option("--seed", options->seed);
  command->callback([options] {
    for (const auto& [sigma_m, sigma_deg] : {std::pair{0.02, 1.0}, std::pair{0.04, 3.0}}) {
      options->odometry_sigma_m = sigma_m;
      options->odometry_sigma_rad = to_radians(sigma_deg);
      print_modes(*options);
    }
  });
}

}  // namespace waymark
