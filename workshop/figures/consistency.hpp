#pragma once

#include <CLI/CLI.hpp>

namespace waymark {

/// Adds `consistency`: the pose NEES of the EKF in its three modes, at mild and at poor odometry, as tables
/// and as a page. `status` becomes what the program is to end with.
void add_consistency(CLI::App& app, int& status);

}  // namespace waymark
