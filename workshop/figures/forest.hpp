#pragma once

#include <CLI/CLI.hpp>

namespace waymark {

/// Adds `forest`: a filter that does not know which landmark it sees against the same one that does, on the
/// same simulated runs.
void add_forest(CLI::App& app);

}  // namespace waymark
