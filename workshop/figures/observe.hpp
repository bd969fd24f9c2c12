#pragma once

#include <CLI/CLI.hpp>

namespace waymark {

/// Adds `observe`: FastSLAM by range and bearing, by range alone and by bearing alone, on the same simulated
/// runs.
void add_observe(CLI::App& app);

}  // namespace waymark
