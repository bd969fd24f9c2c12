#pragma once

#include <CLI/CLI.hpp>

namespace waymark {

/// Adds `budget`: whether images keep to their time while another core is busy, and what a tenth of the
/// time that they would take costs in accuracy. `status` becomes what the program is to end with.
void add_budget(CLI::App& app, int& status);

}  // namespace waymark
