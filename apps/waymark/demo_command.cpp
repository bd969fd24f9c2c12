#include <cstdio>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "commands.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/report/report.hpp"
#include "workbench/report/results.hpp"
#include "workbench/report/run_report.hpp"

namespace waymark::app {
namespace {

struct DemoRequest {
  std::string output = "waymark-demo";
  SettingsFlags flags;
  Verbosity verbosity;
};

/// One filter over the simulated log, its files in a folder of its own.
Result<RunResult> run_filter(const DemoRequest& request, const char* filter) {
  UserSettings user = request.flags.settings();
  user.assignments.push_back(std::string("filter=") + filter);
  auto result = run_log("sim:study", user, {}, [](double) { return !interrupted(); });
  if (!result) return result;
  const auto folder = std::filesystem::path(request.output) / filter;
  if (auto written = write_results(
          *result, folder, fmt::format("waymark run sim:study --filter {} -o {}", filter, folder.string()));
      !written)
    return written.error();
  if (result->recording.error) return *result->recording.error;
  return result;
}

Result<void> demo(const DemoRequest& request) {
  if (auto made = ensure_output_folder(request.output); !made) return made;
  catch_interrupts();
  auto ekf = run_filter(request, "ekf");
  if (!ekf) return ekf.error();
  auto fastslam = run_filter(request, "fastslam");
  if (!fastslam) return fastslam.error();
  ReportData report = make_report(*ekf, command_line());
  report.title = "Waymark demo: one simulated drive, two filters";
  add_run_to(report, *fastslam, command_line());
  const auto path = std::filesystem::path(request.output) / "report.html";
  if (auto written = write_report(report, path); !written) return written;
  if (request.verbosity.json)
    fmt::print("{{\"ekf\": {}, \"fastslam\": {}}}\n", to_json(ekf->metrics), to_json(fastslam->metrics));
  if (request.verbosity.talks())
    fmt::print("{}{}report: {}\n", to_text(ekf->metrics), to_text(fastslam->metrics), path.string());
  return {};
}

}  // namespace

void add_demo(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand(
      "demo", "Simulate a drive, run both filters on it and write a report; needs no data");
  auto request = std::make_shared<DemoRequest>();
  command->add_option("-o,--output", request->output, "folder for the results (default waymark-demo)")
      ->type_name("OUT");
  request->flags.add_to(*command);
  add_verbosity(*command, request->verbosity);
  command->footer("Example:\n  waymark demo --seed 3 -o demo && xdg-open demo/report.html");
  command->callback([&work, request] { work = [request] { return demo(*request); }; });
}

}  // namespace waymark::app
