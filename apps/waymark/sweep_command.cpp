#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>

#include <fmt/format.h>

#include "commands.hpp"
#include "ranks.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/report/sweep_report.hpp"
#include "workbench/study/sweep.hpp"
#include "workbench/study/sweep_summary.hpp"
#include "workbench/study/sweep_workers.hpp"

namespace waymark::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStudy = "study";

struct SweepRequest {
  std::string input = kStudy;
  std::string output = "waymark-sweep";
  std::vector<std::string> axes;
  SettingsFlags flags;
  Verbosity verbosity;
};

/// The axis takes the place of the plan's own of that key, or is a further one.
void put_axis(const study::Axis& axis, study::SweepPlan& plan) {
  bool is_known = false;
  for (auto& block : plan.blocks)
    if (const auto own = std::ranges::find(block, axis.key, &study::Axis::key); own != block.end()) {
      *own = axis;
      is_known = true;
    }
  if (is_known) return;
  for (auto& block : plan.blocks) block.push_back(axis);
}

Result<study::SweepPlan> make_plan(const SweepRequest& request) {
  const bool is_study = request.input == kStudy;
  if (!is_study && request.axes.empty())
    return Error{"sweep: nothing varies; give at least one --axis, for example --axis seed=1..20"};
  study::SweepPlan plan =
      is_study ? study::study_plan() : study::SweepPlan{.input = request.input, .user = {}, .blocks = {{}}};
  std::vector<std::string> given;
  for (const auto& text : request.axes) {
    const auto axis = study::parse_axis(text);
    if (!axis) return axis.error();
    if (std::ranges::find(given, axis->key) != given.end())
      return Error{fmt::format("--axis: {} is given twice; list its values in one", axis->key)};
    given.push_back(axis->key);
    put_axis(*axis, plan);
  }
  SettingsFlags flags = request.flags;
  flags.threads.clear();  // they are for runs beside each other, not within one
  plan.user = flags.settings();
  if (auto checked = check(plan); !checked) return checked.error();
  return plan;
}

/// Runs beside each other in this process.
Result<int> count_threads(const SweepRequest& request, const Ranks& ranks) {
  const auto config = resolve_config(request.flags.settings());
  if (!config) return config.error();
  if (!request.flags.threads.empty()) return config->threads;
  if (ranks.count() > 1) return 1;  // one process per core is started
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

void make_runs(study::Sweep& sweep, Ranks& ranks, int threads, const Verbosity& verbosity) {
  catch_interrupts();
  ProgressBar bar(fmt::format("{} runs", sweep.total()), verbosity);
  study::SweepWorkers sweep_workers(sweep, threads);
  const auto to_do = static_cast<double>(std::max<std::size_t>(1, sweep.total() - sweep.resumed()));
  while (static_cast<int>(ranks.serve(sweep)) + static_cast<int>(sweep_workers.busy()) > 0) {
    if (interrupted()) sweep.stop();
    bar.show(static_cast<double>(sweep.done() - sweep.resumed()) / to_do);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

Result<void> write(const study::Sweep& sweep, const study::SweepSummary& summary, const fs::path& folder) {
  const auto rows = sweep.rows();
  if (auto written = write_file(folder / "sweep.csv", study::csv(sweep.plan(), rows)); !written)
    return written;
  return write_sweep_report({sweep.plan().input, command_line(), rows.size(), summary},
                            folder / "sweep.html");
}

void print(const SweepRequest& request, const study::Sweep& sweep, const study::SweepSummary& summary) {
  if (request.verbosity.json) fmt::print("{}\n", sweep_json_text(summary));
  if (!request.verbosity.talks()) return;
  fmt::print("{} runs on {}, medians over the seeds\n{}", sweep.done(), sweep.plan().input,
             study::to_text(summary));
  fmt::print("table: {0}/sweep.csv\npage: {0}/sweep.html\n", request.output);
}

/// What came in the way, if anything.
Result<void> judge(const study::Sweep& sweep, const std::string& folder) {
  if (sweep.error()) return *sweep.error();
  if (sweep.done() < sweep.total())
    return Error{fmt::format("stopped after {} of {} runs; the same command with -o {} continues",
                             sweep.done(), sweep.total(), folder),
                 Error::Kind::kFailed};
  const auto rows = sweep.rows();
  const auto failed = [](const study::SweepRow& row) { return !row.error.empty(); };
  const auto count = std::ranges::count_if(rows, failed);
  if (count == 0) return {};
  const bool all_refused = std::ranges::all_of(rows, [&failed](const study::SweepRow& row) {
    return failed(row) && row.error_kind == Error::Kind::kBadInput;
  });
  return Error{fmt::format("{} of {} runs failed, the first because: {}", count, rows.size(),
                           std::ranges::find_if(rows, failed)->error),
               all_refused ? Error::Kind::kBadInput : Error::Kind::kFailed};
}

Result<void> sweep_first(const SweepRequest& request, const study::SweepPlan& plan, Ranks& ranks) {
  const auto threads = count_threads(request, ranks);
  if (!threads) return threads.error();
  if (auto opened = open_input(plan.input, plan.user); !opened) return opened.error();
  if (auto made = ensure_output_folder(request.output); !made) return made;
  auto sweep = study::Sweep::open(plan, request.output);
  if (!sweep) return sweep.error();
  if (request.verbosity.talks() && (*sweep)->resumed() > 0)
    fmt::print("{} of {} runs were already done\n", (*sweep)->resumed(), (*sweep)->total());
  make_runs(**sweep, ranks, *threads, request.verbosity);
  const auto summary = study::summarise(plan, (*sweep)->rows());
  if (auto written = write(**sweep, summary, request.output); !written) return written;
  print(request, **sweep, summary);
  return judge(**sweep, request.output);
}

Result<void> sweep(const SweepRequest& request) {
  auto ranks = Ranks::join();
  if (!ranks) return ranks.error();
  const auto plan = make_plan(request);
  if ((*ranks)->is_first()) return plan ? sweep_first(request, *plan, **ranks) : plan.error();
  catch_interrupts();
  if (plan) (*ranks)->work(*plan);
  return {};
}

}  // namespace

void add_sweep(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand(
      "sweep",
      "Run every combination of some settings (seeds, particles, any key) and write a table and a page");
  auto request = std::make_shared<SweepRequest>();
  command->add_option("input", request->input, "log, sim:SCENARIO, or study (default): the built-in study");
  command
      ->add_option("--axis", request->axes,
                   "config key and its values; every combination is run; may be given several times")
      ->type_name("KEY=V,V,..|A..B")
      ->allow_extra_args(false);
  command
      ->add_option("-o,--output", request->output,
                   "folder for the results (default waymark-sweep); an interrupted sweep in it is continued")
      ->type_name("OUT");
  request->flags.add_to(*command);
  add_verbosity(*command, request->verbosity);
  command->footer(
      "Examples:\n"
      "  waymark sweep\n"
      "  waymark sweep sim:study --axis fastslam.particles=10,30,100,300 --axis seed=1..20 --set "
      "filter=fastslam -o out\n"
      "  waymark sweep MRCLAM_Dataset6 --axis input.robot=1..4 --axis filter=ekf,fastslam -o out\n"
      "  mpirun -n 8 waymark sweep study --axis seed=1..100 -o out\n\n"
      "Writes sweep.csv (a row per run), sweep.html and journal.csv, to continue an interrupted sweep.\n"
      "--threads is the number of runs at the same time (default: all cores).");
  command->callback([&work, request] { work = [request] { return sweep(*request); }; });
}

}  // namespace waymark::app
