#include <memory>
#include <optional>

#include <fmt/format.h>

#include "calibrate_commands.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/report/log_calibration_report.hpp"

namespace waymark::app {
namespace {

struct CalibrateOdometryRequest {
  std::string input;
  std::string output = "waymark-calibration";
  TimeSpan span;
  SettingsFlags flags;
  Verbosity verbosity;
};

/// One bar for every run over the log.
Result<calibrate::LogCalibration> calibrate_with_bars(const CalibrateOdometryRequest& request,
                                                      calibrate::Subject subject) {
  std::optional<ProgressBar> bar;
  int shown = -1;
  return calibrate::calibrate_log(request.input, request.flags.settings(), subject, request.span,
                                  [&](int pass, double fraction) {
                                    if (pass != std::exchange(shown, pass)) {
                                      bar.reset();
                                      bar.emplace(fmt::format("run {}", pass + 1), request.verbosity);
                                    }
                                    bar->show(fraction);
                                    return !interrupted();
                                  });
}

Result<void> calibrate_from_log(const CalibrateOdometryRequest& request, calibrate::Subject subject) {
  if (auto made = ensure_output_folder(request.output); !made) return made;
  catch_interrupts();
  const auto calibration = calibrate_with_bars(request, subject);
  if (!calibration) return calibration.error();
  if (auto written = write_results(*calibration, request.output, command_line()); !written) return written;
  if (request.verbosity.json) fmt::print("{}", to_json(*calibration));
  if (!request.verbosity.talks()) return {};
  fmt::print("{0}config: {1}/calibration.yaml\nreport: {1}/report.html\n", to_text(*calibration),
             request.output);
  return {};
}

void add(CLI::App& calibrate, Work& work, const char* name, const char* help, const char* footer,
         calibrate::Subject subject) {
  auto* command = calibrate.add_subcommand(name, help);
  const auto request = std::make_shared<CalibrateOdometryRequest>();
  command
      ->add_option("input", request->input, "a log folder, a ROS bag, a published data set, or sim:SCENARIO")
      ->required()
      ->type_name("LOG");
  command->add_option("-o,--output", request->output, "folder for the results (default waymark-calibration)")
      ->type_name("OUT");
  command->add_option("--from", request->span.from_s, "seconds from the start of the log at which to begin")
      ->type_name("S");
  command->add_option("--to", request->span.to_s, "seconds from the start of the log at which to end")
      ->type_name("S");
  request->flags.add_to(*command);
  add_verbosity(*command, request->verbosity);
  command->footer(footer);
  command->callback([&work, request, subject] {
    work = [request, subject] { return calibrate_from_log(*request, subject); };
  });
}

}  // namespace

void add_calibrate_odometry(CLI::App& calibrate, Work& work) {
  add(calibrate, work, "odometry",
      "Calibrate odometry (wheel radii and track, or scales and bias) from any log with landmarks",
      "Examples:\n"
      "  waymark calibrate odometry LOG -o out && waymark run LOG --config out/calibration.yaml\n"
      "  waymark calibrate odometry LOG --set motion.turn_scale_sigma=0.05\n\n"
      "Writes calibration.yaml (for --config), calibration.json and report.html.\n"
      "The priors are the keys motion.*_sigma* and smooth.*_sigma*.",
      calibrate::Subject::kOdometry);
}

void add_calibrate_mount(CLI::App& calibrate, Work& work) {
  add(calibrate, work, "mount",
      "Calibrate the position of landmark sensor or camera on the robot, and the odometry, from any log with "
      "landmarks",
      "Examples:\n"
      "  waymark calibrate mount LOG -o out && waymark run LOG --config out/calibration.yaml\n"
      "  waymark calibrate mount BAG --set markers.dictionary=4x4_50 --set markers.size_m=0.085\n\n"
      "The robot must turn both left and right: the position of the sensor is observable in turns only.\n"
      "Writes calibration.yaml (for --config), calibration.json and report.html.\n"
      "The priors are smooth.mount_sigma_m, smooth.mount_yaw_sigma_deg and the keys of the odometry.",
      calibrate::Subject::kMount);
}

}  // namespace waymark::app
