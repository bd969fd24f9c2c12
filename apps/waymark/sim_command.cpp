#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "commands.hpp"
#include "workbench/logs/log_writer.hpp"
#include "workbench/sim/options.hpp"

namespace waymark::app {
namespace {

struct SimRequest {
  std::string scenario;
  std::string output;
  SettingsFlags flags;
  Verbosity verbosity;
};

std::string scenario_list() {
  std::string list;
  for (const auto& name : sim::scenario_names()) list += (list.empty() ? "" : ", ") + name;
  return list;
}

Result<void> simulate(const SimRequest& request) {
  auto simulation = open_simulation(request.scenario, request.flags.settings());
  if (!simulation) return simulation.error();
  {
    ProgressBar bar("simulating", request.verbosity);
    const auto show = [&bar](double fraction) { bar.show(fraction); };
    if (auto written = write_log(**simulation, request.output, show); !written) return written;
  }
  if (request.verbosity.talks()) fmt::print("wrote {0}\nnext: waymark run {0} -o out\n", request.output);
  return {};
}

}  // namespace

void add_sim(CLI::App& app, Work& work) {
  auto* command =
      app.add_subcommand("sim", "Simulate a drive and write it as a log folder with ground truth");
  auto request = std::make_shared<SimRequest>();
  command
      ->add_option("scenario", request->scenario,
                   "scenario or FILE.yaml with keys sim.*; scenarios: " + scenario_list())
      ->required()
      ->type_name("SCENARIO");
  command->add_option("-o,--output", request->output, "log folder to write, with ground truth")
      ->required()
      ->type_name("LOG");
  request->flags.add_to(*command);
  command->add_flag("--quiet", request->verbosity.quiet, "print errors only");
  command->footer(
      "Examples:\n"
      "  waymark sim study -o study-log --seed 7\n"
      "  waymark sim room -o room-log --set sim.laps=2 --set sim.walkers=3\n"
      "  waymark sim square -o log --set sim.landmarks=40 --set sim.field_of_view_deg=180");
  command->callback([&work, request] { work = [request] { return simulate(*request); }; });
}

}  // namespace waymark::app
