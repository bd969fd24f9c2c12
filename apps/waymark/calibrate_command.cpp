#include "calibrate_commands.hpp"

namespace waymark::app {

void add_calibrate(CLI::App& app, Work& work) {
  auto* calibrate =
      app.add_subcommand("calibrate", "Calibrate cameras, odometry and landmark sensors from recordings");
  calibrate->require_subcommand(1);
  calibrate->footer(
      "Examples:\n"
      "  waymark calibrate camera photos/ --corners 9x6 --square_m 0.025 -o camera\n"
      "  waymark calibrate odometry LOG -o out && waymark run LOG --config out/calibration.yaml");
  add_calibrate_camera(*calibrate, work);
  add_calibrate_odometry(*calibrate, work);
  add_calibrate_mount(*calibrate, work);
  add_calibrate_sensor(*calibrate, work);
}

}  // namespace waymark::app
