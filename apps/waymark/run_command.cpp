#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "commands.hpp"
#include "filter_flags.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/report/results.hpp"

namespace waymark::app {
namespace {

struct RunRequest {
  std::string input;
  std::string output = "waymark-out";
  FilterFlags filter;
  bool smooth = false;
  TimeSpan span;
  SettingsFlags flags;
  Verbosity verbosity;

  [[nodiscard]] UserSettings settings() const {
    UserSettings user = flags.settings();
    filter.add_to(user);
    if (smooth) user.flags.push_back({"--smooth", "smooth.run", "true"});
    return user;
  }
};

void print_summary(const RunRequest& request, const RunResult& result) {
  if (request.verbosity.json) fmt::print("{}", to_json(result.metrics));
  if (!request.verbosity.talks()) return;
  fmt::print("{}", to_text(result.metrics));
  for (const auto& note : result.recording.notes) fmt::print("  note: {}\n", note);
  fmt::print("report: {}/report.html\n", request.output);
}

Result<void> run(const RunRequest& request) {
  if (auto made = ensure_output_folder(request.output); !made) return made;
  catch_interrupts();
  auto result = [&request] {
    ProgressBar bar("running", request.verbosity);
    return run_log(request.input, request.settings(), request.span, [&bar](double fraction) {
      bar.show(fraction);
      return !interrupted();
    });
  }();
  if (!result) return result.error();
  if (auto written = write_results(*result, request.output, command_line()); !written) return written;
  print_summary(request, *result);
  if (result->recording.error) return *result->recording.error;
  return {};
}

}  // namespace

void add_run(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand("run", "Run a filter over a log; writes path, map, errors and a report");
  auto request = std::make_shared<RunRequest>();
  command
      ->add_option("input", request->input,
                   "a log folder, a ROS bag (or several of one drive), a published data set, or sim:SCENARIO")
      ->required()
      ->type_name("LOG");
  command->add_option("-o,--output", request->output, "folder for the results (default waymark-out)")
      ->type_name("OUT");
  request->filter.add_to(*command);
  command->add_flag("--smooth", request->smooth,
                    "after the log has ended, also estimate path, map and calibration from all of it");
  command->add_option("--from", request->span.from_s, "seconds from the start of the log at which to begin")
      ->type_name("S");
  command->add_option("--to", request->span.to_s, "seconds from the start of the log at which to end")
      ->type_name("S");
  request->flags.add_to(*command);
  add_verbosity(*command, request->verbosity);
  command->footer(
      "Examples:\n"
      "  waymark run LOG -o out\n"
      "  waymark run sim:study --filter fastslam --particles 150 --seed 7 -o out\n"
      "  waymark run sim:room --observe pixel -o out\n"
      "  waymark run LOG --set markers.dictionary=4x4_50 --set markers.size_m=0.085 -o out\n"
      "  waymark run MRCLAM_Dataset6 --set input.robot=3 -o out\n"
      "  waymark run LOG --from 600 --map out/map.waymark -o out2\n"
      "  waymark run LOG2 --map out/map.waymark --localize -o out3\n\n"
      "Writes trajectory.tum, trajectory_covariance.csv, map.csv, map.waymark, config.yaml, metrics.json\n"
      "and report.html. With --smooth also trajectory_smoothed.tum, map_smoothed.csv and calibration.yaml.\n"
      "calibration.yaml is also written with --set ekf.calibrate_odometry=true.");
  command->allow_extras();
  command->callback([&work, request, command] {
    request->flags.take_more_inputs(*command, request->input);
    work = [request] { return run(*request); };
  });
}

}  // namespace waymark::app
