#include <memory>

#include <fmt/format.h>

#include "calibrate_commands.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/report/moving_study_report.hpp"
#include "workbench/report/static_study_report.hpp"

namespace waymark::app {
namespace {

struct CalibrateSensorRequest {
  std::string input;
  std::string places;
  std::string output = "waymark-calibration";
  SettingsFlags flags;
  Verbosity verbosity;
};

/// Of a robot that moves among landmarks.
Result<calibrate::MovingStudy> from_log(const CalibrateSensorRequest& request) {
  ProgressBar bar("calibrating", request.verbosity);
  return calibrate::study_moving(request.input, request.flags.settings(), [&bar](double fraction) {
    bar.show(fraction);
    return !interrupted();
  });
}

/// Of a sensor before landmarks at known places.
Result<calibrate::StaticStudy> from_places(const CalibrateSensorRequest& request) {
  const auto places = calibrate::read_places(request.places);
  if (!places) return places.error();
  ProgressBar bar("recordings", request.verbosity);
  return calibrate::study_places(*places, request.flags.settings(), [&bar](double fraction) {
    bar.show(fraction);
    return !interrupted();
  });
}

/// Writes and says what was found.
template <class Findings>
Result<void> deliver(const Result<Findings>& findings, const CalibrateSensorRequest& request) {
  if (!findings) return findings.error();
  if (auto written = write_results(*findings, request.output, command_line()); !written) return written;
  if (request.verbosity.json) fmt::print("{}", to_json(*findings));
  if (request.verbosity.talks())
    fmt::print("{0}config: {1}/calibration.yaml\n", to_text(*findings), request.output);
  return {};
}

Result<void> calibrate_sensor(const CalibrateSensorRequest& request) {
  if (request.input.empty() == request.places.empty())
    return Error{
        "calibrate sensor: give a log of a moving robot, or --places FILE with recordings of landmarks at "
        "known places"};
  if (auto made = ensure_output_folder(request.output); !made) return made;
  catch_interrupts();
  return request.places.empty() ? deliver(from_log(request), request)
                                : deliver(from_places(request), request);
}

}  // namespace

void add_calibrate_sensor(CLI::App& calibrate, Work& work) {
  auto* command = calibrate.add_subcommand("sensor",
                                           "Estimate noise, bias and delay of a landmark sensor or camera, "
                                           "from a moving robot or landmarks at known places");
  const auto request = std::make_shared<CalibrateSensorRequest>();
  command->add_option("input", request->input,
                      "a log folder, a ROS bag, a published data set, or sim:SCENARIO");
  command
      ->add_option("--places", request->places,
                   "instead of a log: table log,range_m,bearing_deg of recordings, each of a landmark at a "
                   "known place")
      ->type_name("FILE.csv");
  command->add_option("-o,--output", request->output, "folder for the results (default waymark-calibration)")
      ->type_name("OUT");
  request->flags.add_to(*command);
  add_verbosity(*command, request->verbosity);
  command->footer(
      "Examples:\n"
      "  waymark calibrate odometry LOG -o odometry\n"
      "  waymark calibrate sensor LOG --config odometry/calibration.yaml -o sensor     # noise and delay\n"
      "  waymark run LOG --config odometry/calibration.yaml --config sensor/calibration.yaml\n"
      "  waymark calibrate sensor --places places.csv -o out     # biases, noise, range and view limits\n\n"
      "Calibrate odometry and mount first: their errors would count as sensor noise.\n"
      "Writes calibration.yaml (for --config), calibration.json and report.html.");
  command->callback([&work, request] { work = [request] { return calibrate_sensor(*request); }; });
}

}  // namespace waymark::app
