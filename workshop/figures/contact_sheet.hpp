#pragma once

#include <CLI/CLI.hpp>

namespace waymark {

/// Adds `sheet`: images of a log, evenly over its time, side by side in one image. `status` becomes what
/// the program is to end with.
void add_contact_sheet(CLI::App& app, int& status);

}  // namespace waymark
