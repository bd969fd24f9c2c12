#include "calibrate_commands.hpp"

namespace waymark::app {

void add_calibrate(CLI::App& app, Work& work) {
  auto* calibrate = app.add_subcommand("calibrate", "What a robot's sensors are like, from recordings");
  calibrate->require_subcommand(1);
  calibrate->footer("Example:\n  waymark calibrate camera photos/ --corners 9x6 --square_m 0.025 -o camera");
  add_calibrate_camera(*calibrate, work);
}

}  // namespace waymark::app
