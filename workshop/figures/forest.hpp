#pragma once

#include <CLI/CLI.hpp>

namespace waymark {

/// Adds `forest`: a filter that is not observable which landmark it sees against the same one that is, on the
/// same simulated runs.
void add_forest(CLI::App& app);

}  // namespace waymark
