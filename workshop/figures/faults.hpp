#pragma once

#include <CLI/CLI.hpp>

namespace waymark {

/// Adds `faults`: simulated runs with observations that are false and landmarks that are carried, against the
/// same runs without those observations; and `carried`: a robot that is carried, against itself left alone.
void add_faults(CLI::App& app);

}  // namespace waymark
