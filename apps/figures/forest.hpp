#pragma once

#include <CLI/CLI.hpp>

namespace waymark {

/// Adds `forest`: FastSLAM that is not told which landmark it sees against FastSLAM that is, on the same
/// simulated runs.
void add_forest(CLI::App& app);

}  // namespace waymark
