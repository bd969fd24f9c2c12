#pragma once

#include <CLI/CLI.hpp>

namespace waymark {

/// Adds `consistency`: the pose NEES of the EKF in its three modes, at mild and at poor odometry.
void add_consistency(CLI::App& app);

}  // namespace waymark
