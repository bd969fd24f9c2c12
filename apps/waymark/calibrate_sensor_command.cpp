#include <memory>

#include <fmt/format.h>

#include "waymark/io/files.hpp"
#include "waymark/report/sensor_noise_report.hpp"

#include "calibrate_commands.hpp"

namespace waymark::app {
namespace {

struct Request {
  std::string input;
  std::string output = "waymark-calibration";
  SettingsFlags flags;
  Verbosity verbosity;
};

Result<void> calibrate_sensor(const Request& request) {
  if (auto made = ensure_output_folder(request.output); !made) return made;
  catch_interrupts();
  const auto noise = [&request] {
    ProgressBar bar("run after run", request.verbosity);
    return calibrate::calibrate_noise(request.input, request.flags.settings(), [&bar](double fraction) {
      bar.show(fraction);
      return !interrupted();
    });
  }();
  if (!noise) return noise.error();
  if (auto written = write_results(*noise, request.output); !written) return written;
  if (request.verbosity.json) fmt::print("{}", to_json(*noise));
  if (!request.verbosity.talks()) return {};
  fmt::print("{0}config: {1}/calibration.yaml\n", to_text(*noise), request.output);
  return {};
}

}  // namespace

void add_calibrate_sensor(CLI::App& calibrate, Work& work) {
  auto* command = calibrate.add_subcommand(
      "sensor", "Noise of a landmark sensor or camera on a robot that moves among landmarks");
  const auto request = std::make_shared<Request>();
  command
      ->add_option("input", request->input, "a log folder, a ROS bag, a published data set, or sim:SCENARIO")
      ->required();
  command->add_option("-o,--output", request->output, "folder for the results (default waymark-calibration)")
      ->type_name("OUT");
  request->flags.add_to(*command);
  add_verbosity(*command, request->verbosity);
  command->footer(
      "Example:\n"
      "  waymark calibrate sensor LOG -o out && waymark run LOG --config out/calibration.yaml\n\n"
      "Calibrate odometry and mount first: what is wrong with them would count as noise. Writes "
      "calibration.yaml "
      "(for --config) and calibration.json.");
  command->callback([&work, request] { work = [request] { return calibrate_sensor(*request); }; });
}

}  // namespace waymark::app
