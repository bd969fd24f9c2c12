#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>

#include <fmt/format.h>

#include "commands.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/report/tune_report.hpp"
#include "workbench/study/tune.hpp"
#include "workbench/study/tune_text.hpp"

namespace waymark::app {
namespace {

namespace fs = std::filesystem;

struct TuneRequest {
  std::vector<std::string> logs;
  std::string output = "waymark-tune";
  std::vector<std::string> keys;
  std::string by = "likelihood";
  SettingsFlags flags;
  Verbosity verbosity;
};

/// Runs beside each other; each has one thread.
Result<int> count_threads(const TuneRequest& request) {
  const auto config = resolve_config(request.flags.settings());
  if (!config) return config.error();
  if (!request.flags.threads.empty()) return config->threads;
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

Result<study::TuneResult> tune_logs(const TuneRequest& request, int threads) {
  ProgressBar bar("tuning", request.verbosity);
  std::mutex drawing;
  const auto by = request.by == "rmse" ? study::TuneBy::kRmse : study::TuneBy::kLikelihood;
  return study::tune({request.logs, request.flags.settings(), request.keys, by, threads},
                     [&](double fraction) {
                       const std::lock_guard lock(drawing);
                       bar.show(fraction);
                       return !interrupted();
                     });
}

void print(const TuneRequest& request, const study::TuneResult& result) {
  if (request.verbosity.json) fmt::print("{}\n", tune_json_text(result));
  if (!request.verbosity.talks()) return;
  fmt::print("{} runs over {} observations\n{}", result.runs, result.observations, study::to_text(result));
  fmt::print("config: {0}/tuned.yaml\nreport: {0}/report.html\n", request.output);
}

Result<void> tune(const TuneRequest& request) {
  const auto threads = count_threads(request);
  if (!threads) return threads.error();
  if (auto made = ensure_output_folder(request.output); !made) return made;
  catch_interrupts();
  const auto result = tune_logs(request, *threads);
  if (!result) return result.error();
  const fs::path folder = request.output;
  if (auto written = write_file(folder / "tuned.yaml", study::to_yaml(*result)); !written) return written;
  if (auto written = write_tune_report(*result, command_line(), folder / "report.html"); !written)
    return written;
  print(request, *result);
  if (!result->stopped) return {};
  return Error{fmt::format("stopped; the best values so far are in {}/tuned.yaml", request.output),
               Error::Kind::kFailed};
}

}  // namespace

void add_tune(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand(
      "tune", "Find the noise parameters that fit one or several logs best, and write them as a config");
  auto request = std::make_shared<TuneRequest>();
  command
      ->add_option("logs", request->logs,
                   "inputs as for `waymark run`; LOG@KEY=VALUE,KEY=VALUE sets keys for one log only")
      ->required()
      ->type_name("LOG");
  command->add_option("-o,--output", request->output, "folder for the results (default waymark-tune)")
      ->type_name("OUT");
  command
      ->add_option("--keys", request->keys,
                   "config keys to tune; default: noise of odometry and observations")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("KEY,KEY,..");
  command
      ->add_option(
          "--by", request->by,
          "criterion: likelihood (default) of the innovations, or rmse of the path, which needs ground truth")
      ->check(CLI::IsMember({"likelihood", "rmse"}));
  request->flags.add_to(*command);
  add_verbosity(*command, request->verbosity);
  command->footer(
      "Examples:\n"
      "  waymark tune LOG -o out && waymark run LOG --config out/tuned.yaml\n"
      "  waymark tune LOG1 LOG2 LOG3 -o out\n"
      "  waymark tune MRCLAM_Dataset6@input.robot=1 MRCLAM_Dataset6@input.robot=2 -o out\n"
      "  waymark tune LOG --keys sensor.range_sigma_m,sensor.bearing_sigma_deg --by rmse -o out\n\n"
      "Writes tuned.yaml (the tuned keys, for --config) and report.html. Starts at the current values.\n"
      "Cross-validation: each log is left out once (a single log is cut into four parts) and scored\n"
      "with values tuned on the others.\n"
      "--threads is the number of runs at the same time (default: all cores).");
  command->callback([&work, request] { work = [request] { return tune(*request); }; });
}

}  // namespace waymark::app
