#pragma once

#include "commands.hpp"

namespace waymark::app {

/// Each adds its subcommand to `calibrate`.
void add_calibrate_camera(CLI::App& calibrate, Work& work);
void add_calibrate_odometry(CLI::App& calibrate, Work& work);
void add_calibrate_mount(CLI::App& calibrate, Work& work);
void add_calibrate_sensor(CLI::App& calibrate, Work& work);

}  // namespace waymark::app
